"""Mesa's drivers for GPUs that are not in this machine: where they are kept, and how a program runs over them."""
import hashlib
import os
import pathlib
import subprocess

BUILDER = pathlib.Path(__file__).resolve().parent.parent / "drivers" / "build"
NOT_TO_BE_HAD = 77  # the builder ends so when packages cannot be fetched


class Unavailable(Exception):
    """The drivers are not here; the text gives the reason."""


class Gpu:
    """A GPU by its driver: the shim that answers for the kernel, and what makes it answer as this GPU."""

    def __init__(self, title, shim, environment, full_threads):
        self.title, self.shim, self.environment = title, shim, environment
        self.full_threads = full_threads  # threads (or waves) of a shader that is not short of registers

# Mali's numbers are product ids, Adreno's the names of chips.
GPUS = {
    "v3d42": Gpu("V3D 4.2: Raspberry Pi 4", "v3d", {"V3D_DEBUG": "shaderdb"}, 4),
    "v3d71": Gpu("V3D 7.1: Raspberry Pi 5", "v3d", {"V3D_DEBUG": "shaderdb", "V3D_SHIM_VERSION": "71"}, 4),
    "g52": Gpu("Mali-G52 (Bifrost): RK3566, S922X", "panfrost", {"PAN_GPU_ID": "7212"}, 2),
    "a630": Gpu("Adreno 630: Snapdragon 845", "freedreno", {"FD_GPU_ID": "630", "FD_MESA_DEBUG": "shaderdb",
                                                                "GALLIUM_THREAD": "0"}, None),
}


def folder():
    """Where the drivers are kept, by what builds them."""
    digest = hashlib.sha256()
    for path in sorted(BUILDER.parent.iterdir()):
        digest.update(path.read_bytes())
    cache = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    return pathlib.Path(cache) / "pleinair" / f"embedded-gpu-{digest.hexdigest()[:12]}"


def built():
    """The folder of the drivers; raises Unavailable where they have not been built."""
    place = folder()
    if not (place / "complete").exists():
        raise Unavailable("the drivers are not built; ./dev gpu-report builds them, once, in 10 to 20 minutes")
    return place


def build(log):
    """Builds the drivers unless they are there; raises Unavailable where their sources cannot be had."""
    place = folder()
    if (place / "complete").exists():
        return place
    place.mkdir(parents=True, exist_ok=True)
    with open(log, "w", encoding="utf-8") as file:
        status = subprocess.run([str(BUILDER), str(place)], stdout=file, stderr=subprocess.STDOUT, check=False).returncode
    if status == NOT_TO_BE_HAD:
        raise Unavailable(pathlib.Path(log).read_text(encoding="utf-8").strip().splitlines()[-1])
    if status != 0:
        raise RuntimeError(f"building the drivers failed: see {log}")
    return place


def environment(place, gpu):
    """The environment in which a program's EGL is the driver of this GPU."""
    library = place / "lib"
    return dict(os.environ, LD_LIBRARY_PATH=str(library), LIBGL_DRIVERS_PATH=str(library / "dri"),
                GBM_BACKENDS_PATH=str(library / "gbm"), LD_PRELOAD=str(library / f"lib{GPUS[gpu].shim}_noop_drm_shim.so"),
                __EGL_VENDOR_LIBRARY_FILENAMES=str(place / "share/glvnd/egl_vendor.d/50_mesa.json"),
                MESA_SHADER_CACHE_DISABLE="true", **GPUS[gpu].environment)
