"""The kernel compiled by what is at hand: the system's compiler, or the package `ziglang`."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from ...core.errors import InputError

KERNEL = Path(__file__).parent / "kernel"
SOURCES = ("plant.c", "fmi2.c", "fmi3.c")
HEADERS = ("plant.h",)

PLATFORMS = {
    "linux64": ("x86_64-linux", "x86_64-linux-gnu.2.17", ".so"),
    "win64": ("x86_64-windows", "x86_64-windows-gnu", ".dll"),
    "darwin64": ("x86_64-darwin", "x86_64-macos", ".dylib"),
    "linux-aarch64": ("aarch64-linux", "aarch64-linux-gnu.2.17", ".so"),
    "darwin-aarch64": ("aarch64-darwin", "aarch64-macos", ".dylib"),
}
"""By the folder of FMI 2.0: that of FMI 3.0, the target as `zig` says it, the suffix."""
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
    """Return the kernel for some platforms, the own one unless others are named, or for "all".

    Those that no compiler at hand can make are absent.

    Raises
    ------
    InputError
        A platform that is not in `PLATFORMS`.
    """
    own = _own_platform()
    wanted = list(platforms) or ([own] if own else [])
    wanted = list(PLATFORMS) if "all" in wanted else wanted
    for name in wanted:
        if name not in PLATFORMS:
            known = ", ".join(PLATFORMS)
            raise InputError(f"the platform '{name}' is not known; give all, or some of {known}")
    return {name: made for name in wanted if (made := _compiled(name)) is not None}


def _own_platform() -> str | None:
    if sys.platform == "linux":
        known = {"x86_64": "linux64", "aarch64": "linux-aarch64"}
        return known.get(platform.machine())
    if sys.platform == "darwin":
        return "darwin-aarch64" if platform.machine() == "arm64" else "darwin64"
    return "win64" if sys.platform == "win32" and sys.maxsize > 2**32 else None


def _compilers(name: str) -> list[list[str]]:
    found = []
    if name == _own_platform():
        own = [os.environ.get("CC", ""), "cc", "gcc", "clang"]
        found += [[path] for c in own if c and (path := shutil.which(c))][:1]
    if find_spec("ziglang") is not None:
        found.append([sys.executable, "-m", "ziglang", "cc", "-target", PLATFORMS[name][1]])
    return found


@cache
def _compiled(name: str) -> bytes | None:
    for compiler in _compilers(name):
        with TemporaryDirectory(prefix="trueup-kernel-") as folder:
            for source in (*SOURCES, *HEADERS):
                shutil.copyfile(KERNEL / source, Path(folder) / source)
            command = [*compiler, *_FLAGS, *SOURCES, "-o", "kernel"]
            command += [] if name == "win64" else ["-lm"]
            try:
                done = subprocess.run(
                    command, cwd=folder, capture_output=True, timeout=_SECONDS, check=False
                )
            except (OSError, subprocess.TimeoutExpired):
                continue
            made = Path(folder) / "kernel"
            if done.returncode == 0 and made.is_file():
                return made.read_bytes()
    return None
