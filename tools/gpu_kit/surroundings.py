# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What a machine with a GPU has, and what programs of the packed folder need around them there."""
import glob
import os
import pathlib
import re
import shutil
import subprocess

FOLDERS = ["/usr/lib/x86_64-linux-gnu", "/usr/lib64", "/usr/local/nvidia/lib64", "/usr/local/nvidia/lib", "/usr/local/nvidia",
           "/usr/lib/x86_64-linux-gnu/nvidia/current", "/usr/lib/nvidia", "/usr/local/lib", "/opt/nvidia"]


def nvidia_driver():
    """NVIDIA's OpenCL library, which machines for CUDA often have without an ICD file that names it; none: ''."""
    listed = subprocess.run(["ldconfig", "-p"], stdout=subprocess.PIPE, text=True).stdout if shutil.which("ldconfig") else ""
    found = re.findall(r"=> (/\S*libnvidia-opencl\.so\S*)", listed)
    for folder in FOLDERS:
        found += sorted(glob.glob(f"{folder}/libnvidia-opencl.so*")) + sorted(glob.glob(f"{folder}/*/libnvidia-opencl.so*"))
    return found[0] if found else ""


def variables(root, out, driver):
    """Environment variables of the programs: libraries of the packed folder, one driver, caches of its own in `out`."""
    caches = out / "work" / "kernels"
    env = {"CAPLET_CACHE": str(caches / "caplet"), "POCL_CACHE_DIR": str(caches / "pocl"), "CUDA_CACHE_PATH": str(caches / "cuda"),
           "CUDA_CACHE_MAXSIZE": str(4 << 30), "CAPLET_SOURCE": str(root)}
    for name in ("caplet", "pocl", "cuda"):
        (caches / name).mkdir(parents=True, exist_ok=True)
    folders = [str(root / "lib")] if (root / "lib").is_dir() else []
    if driver := driver or nvidia_driver():
        vendors = out / "work" / "icd"
        vendors.mkdir(parents=True, exist_ok=True)
        (vendors / "driver.icd").write_text(f"{driver}\n")
        env["OCL_ICD_VENDORS"] = str(vendors)
        folders.append(str(pathlib.Path(driver).parent))
    if folders:
        env["LD_LIBRARY_PATH"] = ":".join(folders + [os.environ.get("LD_LIBRARY_PATH", "")]).rstrip(":")
    return env


def card():
    """What nvidia-smi says of the card."""
    if not shutil.which("nvidia-smi"):
        return {"left out": "there is no nvidia-smi"}
    wanted = ["name", "driver_version", "memory.total", "clocks.sm", "clocks.max.sm", "clocks.mem", "power.draw", "temperature.gpu"]
    done = subprocess.run(["nvidia-smi", f"--query-gpu={','.join(wanted)}", "--format=csv,noheader"], stdout=subprocess.PIPE, text=True, timeout=30)
    return dict(zip(wanted, done.stdout.strip().split(", ")))
