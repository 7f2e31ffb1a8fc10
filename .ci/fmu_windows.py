"""The library for Windows in units of both versions: fmu_windows.py PROGRAM LINUX_LIBRARY WINDOWS_LIBRARY.

A program in C by the standard's headers is built for Linux and for Windows; what both print is compared."""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import fmpy
from fmpy import extract, read_model_description
from fmpy.validation import validate_fmu

PROGRAM, LINUX, WINDOWS = sys.argv[1:]
FOLDERS = {"2": ("linux64", "win64"), "3": ("x86_64-linux", "x86_64-windows")}
COMPILER = "x86_64-w64-mingw32-gcc"
TOLERANCE = 1e-9  # of the greatest value: the systems' elementary functions differ in the last place
# Of Windows since its version 10, and not of wine before its version 9; Rust's library asks it for random numbers.
PRIMITIVES = """#include <windows.h>
BOOLEAN NTAPI SystemFunction036(PVOID buffer, ULONG size);
__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE buffer, SIZE_T size) { return SystemFunction036(buffer, (ULONG)size); }
"""


def rows(version, compiler, flags, library, runner, unit, resources):
    """What the program prints that this compiler makes."""
    headers, source = Path(fmpy.__file__).parent / "c-code", Path(__file__).with_name(f"fmu{version}.c")
    program = Path(library).with_name("importer.exe" if runner else "importer")
    options = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O2", f"-I{headers}", *flags]
    subprocess.run([compiler, *options, "-o", program, source, library], check=True)
    if runner:
        primitives = program.with_name("primitives.c")
        primitives.write_text(PRIMITIVES)
        stand_in = program.with_name("bcryptprimitives.dll")
        subprocess.run([compiler, "-O2", "-shared", "-o", stand_in, primitives, "-ladvapi32"], check=True)
    description, size = unit
    references = {v.name: str(v.valueReference) for v in description.modelVariables}
    arguments = [description.guid, resources, repr(10.4 * size), references["position_ref_m"], references["machine.position_m"]]
    environment = {**os.environ, "WINEDEBUG": "-all", "WINEPREFIX": str(Path("target/wine").resolve())}
    said = subprocess.run([*runner, program, *arguments], check=True, capture_output=True, text=True, env=environment)
    return [float(line) for line in said.stdout.split()]


def main():
    wine = shutil.which("wine64") or shutil.which("wine")
    for version, folders in FOLDERS.items():
        with tempfile.TemporaryDirectory() as folder:
            fmu = Path(folder) / "unit.fmu"
            axis = ["--axis", "data/axes/liu2025.toml", "--strategy", "feedback", "--fmi", version]
            libraries = ["--library", LINUX, "--library", WINDOWS]
            subprocess.run([PROGRAM, "export", "fmu", *axis, *libraries, "--out", fmu], check=True, stdout=subprocess.DEVNULL)
            problems = validate_fmu(str(fmu))
            assert not problems, problems
            unzipped = Path(extract(str(fmu), folder))
            here, there = (next((unzipped / "binaries" / name).glob("feed_axis.*")) for name in folders)
            description = read_model_description(str(fmu))
            unit = description, float(description.defaultExperiment.stepSize)
            # FMI 2.0 gives a URI, FMI 3.0 a path.
            path = unzipped / "resources"
            drive = f"file:///Z:{path}" if version == "2" else f"Z:{path}".replace("/", "\\")
            # By the name that the library has where it is linked to.
            os.rename(there, there.with_name("feed_axis_fmu.dll"))
            there = there.with_name("feed_axis_fmu.dll")
            if not wine:
                print(f"skipped: no wine: the unit of FMI {version} was built for Windows and not run there")
                continue
            expected = rows(version, "cc", [f"-Wl,-rpath,{here.parent}"], here, [], unit, path.as_uri() if version == "2" else str(path))
            found = rows(version, COMPILER, [], there, [wine], unit, drive)
            assert len(found) == len(expected) == 30
            off = max(abs(a - b) for a, b in zip(found, expected)) / max(map(abs, expected))
            assert off <= TOLERANCE, off
            print(f"FMI {version}: {len(found)} values of the compensated drive under wine, off by {off:.1e}")


main()
