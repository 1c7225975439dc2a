# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Where each driver comes from, and what a command needs around it to see that driver alone.

A driver is put into a folder of the cache, never into the system; what apt installs there is `./run drivers`' own business. One that
cannot be had here raises LeftOut with the reason.
"""
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
RELEASE = ROOT / "build" / "release"
BINARIES = {
    "caplet": RELEASE / "bin/caplet",
    "render_tests": RELEASE / "tests/render/render_tests",
    "trace_tests": RELEASE / "tests/bvh/trace_tests",
}


class LeftOut(Exception):
    """Why a driver cannot be tried here."""


@dataclasses.dataclass
class Home:
    env: dict  # variables to set
    prefix: list  # words before a command
    package: str = ""  # version of the package, where the driver's own says something else


def run_quietly(command, what, **more):
    """Its output as text. Raises LeftOut with the last line that it printed."""
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              errors="replace", **more)
    except OSError as error:
        raise LeftOut(f"{what}: {error}") from error
    if done.returncode != 0:
        lines = [line for line in done.stdout.splitlines() if line.strip()]
        raise LeftOut(f"{what}: {lines[-1].strip() if lines else 'failed'}")
    return done.stdout


def vendors(cache, name, library):
    """A folder with one .icd file, for OCL_ICD_VENDORS."""
    folder = cache / name / "icd"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "driver.icd").write_text(f"{library}\n")
    return str(folder)


def caches(cache, name):
    """The caches of Caplet and of the driver, of its own."""
    base = cache / name / "kernels"
    for folder in ("caplet", "pocl", "mesa"):
        (base / folder).mkdir(parents=True, exist_ok=True)
    return {"CAPLET_CACHE": str(base / "caplet"), "POCL_CACHE_DIR": str(base / "pocl"), "MESA_SHADER_CACHE_DIR": str(base / "mesa")}


# --- The system's ---

def system_library(file):
    """The library that /etc/OpenCL/vendors/FILE names."""
    path = pathlib.Path("/etc/OpenCL/vendors") / file
    if not path.exists():
        raise LeftOut(f"{path} is not there: its package is not installed")
    return path.read_text().split()[0]


def system(cache, name, file, variables):
    return Home({**caches(cache, name), **variables, "OCL_ICD_VENDORS": vendors(cache, name, system_library(file))}, [])


def oclgrind(cache, name):
    """In Oclgrind, with what it needs to understand a kernel (tools/oclgrind.sh)."""
    if not shutil.which("oclgrind"):
        raise LeftOut("oclgrind is not installed")
    return Home(caches(cache, name), ["oclgrind", "--num-threads", "1", "--build-options", "-cl-opt-disable -fpreserve-vec3-type"])


# --- PyPI's ---

def wheels(cache, wanted):
    """A folder with the wheels of these packages ("name==version"; "name": the newest; VERSION: that of the first)."""
    folder = cache / "wheels" / re.sub(r"[^\w.]+", "-", wanted[0])
    if not (folder / ".done").exists():
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        pip = [sys.executable, "-m", "pip", "download", "-q", "--disable-pip-version-check", "--no-deps", "--only-binary", ":all:", "-d", str(folder)]
        run_quietly(pip + wanted[:1], f"pip download {wanted[0]}")
        version = next(folder.glob("*.whl")).name.split("-")[1]
        for more in wanted[1:]:
            run_quietly(pip + [more.replace("VERSION", version)], f"pip download {more}")
        (folder / ".done").touch()
    return folder


def unpack_libraries(folder, to):
    """The libraries of all wheels of a folder, together in one, as an installation would have them."""
    if (to / ".done").exists():
        return
    shutil.rmtree(to, ignore_errors=True)
    to.mkdir(parents=True)
    for wheel in sorted(folder.glob("*.whl")):
        with zipfile.ZipFile(wheel) as file:
            for entry in file.infolist():
                base = pathlib.PurePosixPath(entry.filename).name
                # The loader is the system's.
                if re.search(r"(^|/)(lib|\.libs)/[^/]+$", entry.filename) and not base.startswith(("libOpenCL.so", "libsycl")):
                    (to / base).write_bytes(file.read(entry))
    (to / ".done").touch()


def intel(cache, name, version):
    pin = f"=={version}" if version else ""
    wanted = [f"intel-opencl-rt{pin}", "intel-cmplr-lib-rt==VERSION"]
    if not version or version >= "2025":
        wanted.append("tbb")
    libraries = cache / name / "lib"
    folder = wheels(cache, wanted)
    unpack_libraries(folder, libraries)
    path = str(libraries)
    if (libraries / "libtbb.so.12").exists():
        # Caplet has loaded the system's by the time that the driver asks for a newer one (docs/drivers.md).
        alone = cache / name / "tbb"
        alone.mkdir(exist_ok=True)
        shutil.copy(libraries / "libtbb.so.12", alone)
        path = str(alone)
    variables = {"OCL_ICD_VENDORS": vendors(cache, name, libraries / "libintelocl.so"), "LD_LIBRARY_PATH": path}
    return Home({**caches(cache, name), **variables}, [], next(folder.glob("intel_opencl_rt-*")).name.split("-")[1])


def pocl_of_pypi(cache, name):
    # The library looks for its own files beside it.
    whole = cache / name / "wheel"
    with zipfile.ZipFile(next(wheels(cache, ["pocl-binary-distribution==3.0"]).glob("*.whl"))) as file:
        file.extractall(whole)
    library = next(whole.glob("**/libpocl*.so*"), None)
    if library is None:
        raise LeftOut("the wheel holds no libpocl")
    return Home({**caches(cache, name), "OCL_ICD_VENDORS": vendors(cache, name, library)}, [])


# --- Newer Debians' ---

def mirror():
    """Where this machine gets its packages; none: what debootstrap knows."""
    files = [*pathlib.Path("/etc/apt").glob("sources.list"), *pathlib.Path("/etc/apt/sources.list.d").glob("*")]
    for file in sorted(files):
        for line in file.read_text(errors="replace").splitlines():
            found = re.match(r"(?:URIs:|deb\s(?:\[[^]]*\])?)\s*(\w+://\S+)", line)
            if found and "security" not in line:
                return [found[1]]
    return []


def base_system(cache, suite):
    """A bare Debian of this suite with its PoCL and Mesa, in a folder of the cache."""
    base = cache / suite
    if (base / ".done").exists():
        return base
    if os.geteuid() != 0:
        raise LeftOut(f"Debian {suite} in a chroot needs root")
    for program in ("debootstrap", "unshare", "chroot"):
        if not shutil.which(program):
            raise LeftOut(f"{program} is not installed")
    if base.exists():
        shutil.rmtree(base)
    base.parent.mkdir(parents=True, exist_ok=True)
    run_quietly(["debootstrap", "--variant=minbase", suite, str(base), *mirror()], f"debootstrap {suite}")
    for file in ("/etc/resolv.conf", "/etc/hosts"):
        if os.path.exists(file):
            shutil.copy(file, str(base) + file)
    for file in pathlib.Path("/etc/apt/apt.conf.d").glob("99*"):
        shutil.copy(file, base / "etc/apt/apt.conf.d")
    packages = "pocl-opencl-icd mesa-opencl-icd ocl-icd-libopencl1"
    script = f"apt-get update -qq && apt-get install -y -qq --no-install-recommends {packages} && apt-get clean"
    run_quietly([*inside(base, []), "env", "DEBIAN_FRONTEND=noninteractive", "bash", "-c", script], f"apt-get install in {suite}")
    (base / ".done").touch()
    return base


def inside(base, folders):
    """The words before a command that runs in a chroot, which sees these folders at their places and this system under /host. Its
    mounts are its own and end with it."""
    binds = "".join(f'mkdir -p "$0{folder}" && mount --bind "{folder}" "$0{folder}" && ' for folder in folders)
    script = (f'mount -t proc proc "$0/proc" && mount --rbind /sys "$0/sys" && mount --rbind /dev "$0/dev" && mkdir -p "$0/host" && mount --bind / "$0/host" && '
              f'{binds}exec chroot "$0" "$@"')
    return ["unshare", "--mount", "--propagation", "private", "bash", "-c", script, str(base)]


def host_libraries(base, folder):
    """Links to the libraries of this system that the programs need and the other lacks: the newer C library runs both."""
    folder.mkdir(parents=True, exist_ok=True)
    has = set(re.findall(r"^\s+(\S+) \(", run_quietly(["chroot", str(base), "/sbin/ldconfig", "-p"], "ldconfig"), re.MULTILINE))
    for binary in BINARIES.values():
        for name, path in re.findall(r"^\s*(\S+) => (/\S+)", run_quietly(["ldd", str(binary)], "ldd"), re.MULTILINE):
            link = folder / name
            if name not in has and not link.is_symlink():
                link.symlink_to("/host" + os.path.realpath(path))


def newer_debian(cache, name, suite, library, variables):
    base = base_system(cache, suite)
    icd = base / "etc/OpenCL/vendors" / library
    if not icd.exists():
        raise LeftOut(f"Debian {suite} has no {library}")
    libraries = cache / name / "host-lib"
    host_libraries(base, libraries)
    folders = dict.fromkeys([str(ROOT), str(cache), *([os.environ["CAPLET_DATA"]] if os.environ.get("CAPLET_DATA") else [])])
    env = {**caches(cache, name), **variables, "OCL_ICD_VENDORS": vendors(cache, name, icd.read_text().split()[0]),
           "LD_LIBRARY_PATH": str(libraries)}
    # The variable would break this system's own bash and chroot: it is set inside.
    words = [f"{key}={value}" for key, value in env.items()]
    return Home({}, [*inside(base, list(folders)), "env", *words])
