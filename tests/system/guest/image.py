"""The guest's image: built once and kept in the user's cache for all checkouts. It is rebuilt when its
inputs change: the scripts beside this file, or the packages that the program needs."""
import contextlib
import fcntl
import hashlib
import os
import shutil
import signal
import subprocess

HERE = os.path.dirname(os.path.abspath(__file__))
BUILT_FROM = ("build", "init", "initrd-init")
BUILD_SECONDS = 900
KEPT_IMAGES = 3
# The programs that the scripts call, with their Debian packages.
TOOLS = {
    "qemu-system-x86_64": "qemu-system-x86", "mmdebstrap": "mmdebstrap", "mke2fs": "e2fsprogs",
    "busybox": "busybox-static", "cpio": "cpio", "modprobe": "kmod", "make": "make", "gcc": "gcc",
    "fakeroot": "fakeroot", "objdump": "binutils"}
NOT_TO_BE_HAD = 77  # `build` ends so when packages cannot be fetched


class Unavailable(Exception):
    """This machine cannot run a guest; the text gives the reason."""


def check_machine():
    """Raises Unavailable if guests cannot be built or run."""
    path = os.environ.get("PATH", os.defpath) + ":/usr/sbin:/sbin"
    missing = [package for tool, package in TOOLS.items()
               if package != "fakeroot" or os.geteuid() != 0
               if not shutil.which(tool, path=path)]
    if missing:
        raise Unavailable(f"not installed: {' '.join(missing)}; ./dev test system installs them")
    if os.uname().machine != "x86_64":
        raise Unavailable(f"the guest is for x86_64, this machine is {os.uname().machine}")
    with open("/etc/os-release") as file:
        if "VERSION_CODENAME=bookworm" not in file.read():
            raise Unavailable("the guest runs what is built on Debian 12; this is another system")


def packages_of(program):
    """The Debian packages of the libraries that a program links directly; these pull in the others."""
    needed = [line.split()[1] for line in _output("objdump", "-p", program).splitlines()
              if "NEEDED" in line]
    found = {line.split()[0]: line.split()[2] for line in _output("ldd", program).splitlines()
             if "=> /" in line}
    packages = set()
    for library in needed:
        if library not in found:
            continue  # the loader itself
        # Debian's database knows some files by the path that /lib had before it moved into /usr.
        paths = [found[library], found[library].removeprefix("/usr"), "/usr" + found[library]]
        paths += [os.path.realpath(found[library])]
        listing = subprocess.run(["dpkg-query", "-S", *paths], capture_output=True, text=True)
        packages.update(line.split(":")[0] for line in listing.stdout.splitlines())
    return sorted(packages)


def ready_image(programs, log):
    """The folder of an image for these programs; builds the image if there is none."""
    check_machine()
    packages = sorted({package for program in programs for package in packages_of(program)})
    key = hashlib.sha256(" ".join(packages).encode())
    for name in BUILT_FROM:
        with open(os.path.join(HERE, name), "rb") as file:
            key.update(file.read())
    cache = os.path.join(
        os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache"), "pleinair")
    os.makedirs(cache, exist_ok=True)
    image = os.path.join(cache, "guest-" + key.hexdigest()[:16])
    with _lock(os.path.join(cache, "guest.lock")):
        if not os.path.isdir(image):
            _build(image, packages, log)
        os.utime(image)
        _prune(cache)
    return image


def _output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@contextlib.contextmanager
def _lock(path):
    """A lock of one process at a time, released when the process ends."""
    with open(path, "w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def _build(image, packages, log):
    """Builds the image under a temporary name and renames it when it is complete."""
    unfinished = image + ".part"
    shutil.rmtree(unfinished, ignore_errors=True)
    os.mkdir(unfinished)
    command = [os.path.join(HERE, "build"), unfinished, *packages]
    try:
        with open(log, "w") as file:
            status = _run_within(command, file, BUILD_SECONDS)
        if status == NOT_TO_BE_HAD:
            raise Unavailable(f"its packages cannot be had: {_tail(log, 3)}")
        if status != 0:
            raise RuntimeError(f"the image cannot be built ({status}):\n{_tail(log, 40)}")
        os.rename(unfinished, image)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)


def _run_within(command, log, seconds):
    """Runs a command; after its deadline, terminates it and its children, then kills them."""
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log,
                               stderr=subprocess.STDOUT, start_new_session=True)
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        raise Unavailable(f"building it takes more than {seconds} s") from None
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGTERM)  # mmdebstrap unmounts what it mounted
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()


def _prune(cache):
    """Removes all but the most recently used images."""
    images = [entry for entry in os.scandir(cache)
              if entry.name.startswith("guest-") and entry.is_dir()]
    images.sort(key=lambda entry: entry.stat().st_mtime, reverse=True)
    for entry in images[KEPT_IMAGES:]:
        shutil.rmtree(entry.path, ignore_errors=True)


def _tail(path, lines):
    with open(path, errors="replace") as file:
        return "\n".join(file.read().splitlines()[-lines:])
