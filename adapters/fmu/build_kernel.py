"""The kernel compiled by what is at hand: the system's compiler, or the package `ziglang`."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from ...core.errors import InputError
from ...core.files import replacing

KERNEL = Path(__file__).parent / "kernel"
SOURCES = ("plant.c", "fmi2.c", "fmi3.c")
HEADERS = ("plant.h",)

PLATFORMS = {
    "linux64": ("x86_64-linux", "x86_64-linux-gnu.2.17", ".so", "x86_64-linux-gnu-gcc"),
    "win64": ("x86_64-windows", "x86_64-windows-gnu", ".dll", "x86_64-w64-mingw32-gcc"),
    "darwin64": ("x86_64-darwin", "x86_64-macos", ".dylib", "o64-clang"),
    "linux-aarch64": (
        "aarch64-linux", "aarch64-linux-gnu.2.17", ".so", "aarch64-linux-gnu-gcc"
    ),
    "darwin-aarch64": ("aarch64-darwin", "aarch64-macos", ".dylib", "oa64-clang"),
}  # fmt: skip
"""By the folder of FMI 2.0: that of FMI 3.0, the target as `zig` says it, the suffix, a
cross-compiler."""
_FLAGS = (
    "-std=c99",
    "-DOLD_GLIBC",
    "-O2",
    "-ftree-vectorize",
    "-fPIC",
    "-shared",
    "-fvisibility=hidden",
    "-s",
)
_SECONDS = 900.0
"""`zig` compiles the libraries of a platform when it is first asked for it."""


def binaries(platforms: Sequence[str] = ()) -> Mapping[str, bytes]:
    """Return the kernel for some platforms; by default for all that a compiler at hand knows.

    What was compiled is kept in the user's cache (``$XDG_CACHE_HOME/trueup``, ``~/.cache/trueup``).
    Platforms that no compiler at hand can make are absent.

    Raises
    ------
    InputError
        A platform that is not in `PLATFORMS`.
    """
    wanted = list(PLATFORMS) if not platforms or "all" in platforms else list(platforms)
    for name in wanted:
        if name not in PLATFORMS:
            known = ", ".join(PLATFORMS)
            raise InputError(f"the platform '{name}' is not known; give all, or some of {known}")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        made = zip(wanted, pool.map(_kernel, wanted), strict=True)
        return {name: content for name, content in made if content is not None}


def _own_platform() -> str | None:
    if sys.platform == "linux":
        known = {"x86_64": "linux64", "aarch64": "linux-aarch64"}
        return known.get(platform.machine())
    if sys.platform == "darwin":
        return "darwin-aarch64" if platform.machine() == "arm64" else "darwin64"
    return "win64" if sys.platform == "win32" and sys.maxsize > 2**32 else None


def _compilers(name: str) -> list[tuple[Path, list[str]]]:
    """Return what may compile for a platform: the program that is run, and the command."""
    candidates = [PLATFORMS[name][3]]
    if name == _own_platform():
        candidates = [os.environ.get("CC", ""), "cc", "gcc", "clang", *candidates]
    found = [(Path(path), [path]) for c in candidates if c and (path := shutil.which(c))][:1]
    zig = find_spec("ziglang")
    if zig is not None and zig.origin:
        command = [sys.executable, "-m", "ziglang", "cc", "-target", PLATFORMS[name][1]]
        found.append((Path(zig.origin), command))
    return found


def _kernel(name: str) -> bytes | None:
    sources = {s: (KERNEL / s).read_bytes() for s in (*SOURCES, *HEADERS)}
    for program, compiler in _compilers(name):
        made_as = f"kernel{PLATFORMS[name][2]}"
        command = [*compiler, *_FLAGS, *SOURCES, "-o", made_as, *["-lm"] * (name != "win64")]
        age = program.stat().st_mtime_ns
        made_of = repr((command, str(program.resolve()), age, sorted(sources.items())))
        kept = _cache() / f"kernel-{name}-{sha256(made_of.encode()).hexdigest()[:32]}"
        if kept.is_file():
            return kept.read_bytes()
        made = _compiled(command, sources, made_as)
        if made is not None:
            with suppress(OSError, InputError):
                kept.parent.mkdir(parents=True, exist_ok=True)
                with replacing(kept) as fresh:
                    fresh.write_bytes(made)
            return made
    return None


def _cache() -> Path:
    return Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()) / "trueup"


def _compiled(command: Sequence[str], sources: Mapping[str, bytes], made_as: str) -> bytes | None:
    with TemporaryDirectory(prefix="trueup-kernel-") as folder:
        for name, content in sources.items():
            (Path(folder) / name).write_bytes(content)
        try:
            done = subprocess.run(
                command, cwd=folder, capture_output=True, timeout=_SECONDS, check=False
            )
        except (OSError, subprocess.TimeoutExpired):
            return None
        made = Path(folder) / made_as
        return made.read_bytes() if done.returncode == 0 and made.is_file() else None
