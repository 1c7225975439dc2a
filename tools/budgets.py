#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What the stages' kernels need on GPUs that are not there: registers, memory a thread, code.

usage: budgets.py TEXTS [--quick] [--write]

TEXTS: the program caplet_stage_texts. Every stage's text, as a render on a GPU gives it to a driver, is compiled
- for nvptx64 by clang, and by ptxas for sm_90 (PATH, $CAPLET_PTXAS, or bin/ptxas of $CUDA_HOME),
- for amdgcn (gfx90a, gfx1100) by clang,
- to SPIR-V by clang and llvm-spirv 14, looked at by spirv-val,
with libclc's built-in functions. Where a compiler is missing the output says what is left out.
--quick: the stages that trace rays and those that compile in seconds, without the stages that shade. --write: the table of docs/performance.md.
Exit status: 0; 1 when a stage does not compile, spills, or is beyond its limit in tools/budgets.toml; 77 when there is no compiler at all.
"""
import concurrent.futures
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/performance.md"
BEGIN, END = "<!-- budgets: ./run budgets --write -->", "<!-- end of budgets -->"
SETS = {
    "capsules": "capsule",
    "basic": "sphere,capsule,tapered_capsule,triangle,instance",
    "all": "all",
}
TITLES = {"capsules": "capsules alone, no instances", "basic": "spheres, capsules, tapered ones, triangles, instances", "all": "every shape"}
SLOW = {"shade", "shade_media", "sample_distance"}
OPTIONS = ["-x", "cl", "-cl-std=CL1.2", "-Xclang", "-finclude-default-header", "-DCAPLET_REAL_WIDTH=1"]
CLC = pathlib.Path("/usr/lib/clc")
SKIPPED = 77


def command(arguments, timeout=1500):
    return subprocess.run(arguments, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=timeout)


def trial(arguments, text):
    """Whether the compiler takes a small kernel."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "trial.cl")
        file.write_text(text)
        return command([*arguments, str(file), "-o", str(pathlib.Path(folder, "out"))]).returncode == 0


TRIAL = "__kernel void trial(__global float* x) { x[get_global_id(0)] = fmax(x[0], sqrt(x[1])); }\n"


def amd(clang, chip):
    return [clang, *OPTIONS, "-O3", "-target", "amdgcn--amdhsa", f"-mcpu={chip}", "-nogpulib", "-Xclang", "-mlink-builtin-bitcode", "-Xclang",
            str(CLC / "amdgcn--amdhsa.bc"), "-S"]


def nvidia(clang):
    return [clang, *OPTIONS, "-O3", "-target", "nvptx64-nvidia-nvcl", "-march=sm_90", "-Xclang", "-mlink-builtin-bitcode", "-Xclang",
            str(CLC / "nvptx64--nvidiacl.bc"), "-S"]


def spirv(clang):
    # Without optimisation: the translator knows no instructions that optimisers make.
    return [clang, *OPTIONS, "-O0", "-target", "spir64-unknown-unknown", "-emit-llvm", "-c"]


def find_ptxas():
    for path in (os.environ.get("CAPLET_PTXAS"), shutil.which("ptxas"), os.environ.get("CUDA_HOME", "/usr/local/cuda") + "/bin/ptxas"):
        if path and os.access(path, os.X_OK):
            return path
    return None


def find_targets():
    """By name what compiles for it, and what is left out and why."""
    targets, left_out = {}, []
    clangs = [c for c in (os.environ.get("CAPLET_CLANG"), "clang-19", "clang-20", "clang-18", "clang-17", "clang-16", "clang") if c and shutil.which(c)]
    for name, make, needs in (("sm_90", nvidia, "clang and libclc of one version (clang-19 libclc-19)"),
                              ("gfx1100", lambda c: amd(c, "gfx1100"), "clang and libclc of one version (clang-19 libclc-19)"),
                              ("gfx90a", lambda c: amd(c, "gfx90a"), "clang and libclc of one version (clang-19 libclc-19)")):
        found = next((c for c in clangs if trial(make(c), TRIAL)), None)
        if found is None:
            left_out.append(f"{name}: needs {needs}")
        else:
            targets[name] = make(found)
    if "sm_90" in targets and find_ptxas() is None:
        left_out.append("sm_90: compiled to PTX, but registers and stack are not known without ptxas (CUDA toolkit)")
    if shutil.which("clang-14") and shutil.which("llvm-spirv-14") and trial(spirv("clang-14"), TRIAL):
        targets["SPIR-V"] = spirv("clang-14")
    else:
        left_out.append("SPIR-V: needs clang-14 and llvm-spirv-14")
    return targets, left_out


def code_size(cubin):
    """Bytes of the sections .text.* of an ELF file."""
    data = cubin.read_bytes()
    table, = struct.unpack_from("<Q", data, 0x28)
    size, count, names = struct.unpack_from("<HHH", data, 0x3A)
    sections = [struct.unpack_from("<IIQQQQIIQQ", data, table + i * size) for i in range(count)]
    strings = sections[names][4]
    total = 0
    for section in sections:
        name = data[strings + section[0]:data.index(b"\0", strings + section[0])]
        if name.startswith(b".text."):
            total += section[5]
    return total


def number(pattern, text):
    found = re.findall(pattern, text)
    return max(map(int, found)) if found else 0


def amd_spills(said):
    """Bytes of vector registers that an assembly text of amdgcn spills.

    .vgpr_spill_count does not tell: it counts spills that were removed later. A function that is called saves v40 and others for its caller
    before its first branch; that is no spill.
    """
    kernels = set(re.findall(r"\.amdhsa_kernel (\w+)", said))
    spilled, function, is_prologue = 0, "", False
    for line in said.splitlines():
        if found := re.match(r"(\w+):\s+; @", line):
            function, is_prologue = found[1], True
        elif re.match(r"\.LBB|\ts_cbranch", line):
            is_prologue = False
        elif (found := re.search(r"; (\d+)-byte Folded Spill", line)) and (function in kernels or not is_prologue):
            spilled += int(found[1])
    return spilled


def measure(target, arguments, text, out):
    """Returns {registers, stack, spill, code} of one stage, or an error."""
    result = command([*arguments, str(text), "-o", str(out)])
    if result.returncode != 0:
        return {"error": result.stdout.strip()[:2000]}
    if target == "sm_90":
        ptxas = find_ptxas()
        if ptxas is None:
            return {}
        cubin = out.with_suffix(".cubin")
        result = command([ptxas, "-arch=sm_90", "-v", str(out), "-o", str(cubin)])
        if result.returncode != 0:
            return {"error": result.stdout.strip()[:2000]}
        said = result.stdout
        return {"registers": number(r"Used (\d+) registers", said),
                "stack": max(number(r"(\d+) bytes cumulative stack", said), number(r"(\d+) bytes stack frame", said)),
                "spill": number(r"(\d+) bytes spill stores", said) + number(r"(\d+) bytes spill loads", said), "code": code_size(cubin)}
    if target == "SPIR-V":
        module = out.with_suffix(".spv")
        result = command(["llvm-spirv-14", "--spirv-max-version=1.0", str(out), "-o", str(module)])
        if result.returncode == 0 and shutil.which("spirv-val"):
            result = command(["spirv-val", "--target-env", "opencl1.2", str(module)])
        if result.returncode != 0:
            return {"error": result.stdout.strip()[:2000]}
        return {"code": module.stat().st_size}
    said = out.read_text()
    return {"registers": number(r"; NumVgprs: (\d+)", said), "stack": number(r"; ScratchSize: (\d+)", said),
            "spill": amd_spills(said), "scalar spill": number(r"\.sgpr_spill_count: +(\d+)", said),
            "code": number(r"; codeLenInByte = (\d+)", said), "waves": number(r"; Occupancy: (\d+)", said)}


def judge(name, stage, target, figures, limits):
    """What is wrong with them."""
    where = f"{stage}, {TITLES[name]}, {target}"
    if "error" in figures:
        return [f"{where}: does not compile: {figures['error']}"]
    wrong = [f"{where}: spills {figures['spill']}"] if figures.get("spill", 0) > 0 else []
    limit = limits.get(target, {}).get(name, {}).get(stage, {})
    for what, most in limit.items():
        if figures.get(what, 0) > most:
            wrong.append(f"{where}: {what} {figures[what]}, the limit is {most}")
    return wrong


def cell(figures):
    if not figures:
        return "compiles"
    if "error" in figures:
        return "**fails**"
    if "registers" not in figures:
        return "valid"
    text = f"{figures['registers']}/{figures['stack']}/{figures['code'] / 1000:.0f}"
    return text + (f", {figures['scalar spill']} scalars spilled" if figures.get("scalar spill") else "")


def table(figures, targets):
    valid = [t for t in targets if all(cell(row) == "valid" for (_, _, target), row in figures.items() if target == t)]
    targets = [t for t in targets if t not in valid]
    lines = ["| stage | " + " | ".join(targets) + " |", "|---|" + "---|" * len(targets)]
    for name in SETS:
        stages = {stage for one, stage, _ in figures if one == name}
        if stages:
            lines.append(f"| *{TITLES[name]}* |" + " |" * len(targets))
        for stage in sorted(stages):
            lines.append(f"| {stage} | " + " | ".join(cell(figures.get((name, stage, t), {})) for t in targets) + " |")
    lines += ["", f"{' and '.join(valid)} of all stages is valid."] if valid else []
    return "\n".join(lines)


def main(arguments):
    if not arguments or any(a not in ("--quick", "--write") for a in arguments[1:]):
        print(__doc__, file=sys.stderr)
        return 2
    quick, write = "--quick" in arguments, "--write" in arguments
    targets, left_out = find_targets()
    for what in left_out:
        print(f"LEFT OUT: {what}")
    if not targets:
        return SKIPPED
    limits = tomllib.loads((ROOT / "tools/budgets.toml").read_text())
    figures = {}
    environment = {**os.environ, "CAPLET_KERNELS": str(ROOT / "kernels")}
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        jobs = {}
        for name, shapes in SETS.items():
            texts = pathlib.Path(folder, name)
            subprocess.run([arguments[0], str(texts), shapes], check=True, env=environment)
            for text in sorted(texts.glob("*.cl")):
                if (quick and text.stem in SLOW) or (name != "all" and text.stem not in ("extend", "connect", "shade")):
                    continue
                for target, compiler in targets.items():
                    out = pathlib.Path(folder, f"{name}-{text.stem}-{target}.out")
                    jobs[pool.submit(measure, target, compiler, text, out)] = (name, text.stem, target)
        for job in concurrent.futures.as_completed(jobs):
            figures[jobs[job]] = job.result()
    wrong = [line for key in sorted(figures) for line in judge(*key, figures[key], limits)]
    page = table(figures, list(targets))
    print(page)
    for line in wrong:
        print(f"WRONG: {line}")
    if write and not wrong:
        before, rest = PAGE.read_text().split(BEGIN)
        PAGE.write_text(f"{before}{BEGIN}\n\n{page}\n\n{END}{rest.split(END)[1]}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
