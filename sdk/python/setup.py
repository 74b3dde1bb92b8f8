"""Installs the module karst into a Python of your own: `pip install .` in this folder.

What of the module is in C++ comes from an installed karst, built for the same Python: the program that the environment
variable KARST names, else the one on the PATH. Its version must be that of this folder.
"""

import importlib.machinery
import os
import re
import shutil
import subprocess
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py
from setuptools.dist import Distribution

VERSION = "0.1.0"
COMPILED = ("_karst", "_maps")


def karst_folder() -> Path:
    """The package of the installed karst."""
    program = shutil.which(os.environ.get("KARST", "karst"))
    if program is None:
        raise SystemExit("karst is not installed: set the environment variable KARST to the program, or the PATH")
    said = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    found = re.search(r"\d+\.\d+\.\d+", said)
    if found is None or found[0] != VERSION:
        raise SystemExit(f"{program} is version {said.strip()}, and this module is {VERSION}")
    return Path(program).resolve().parents[1] / "lib/karst/python/karst"


class WithCompiled(build_py):
    def run(self) -> None:
        super().run()
        folder = karst_folder()
        for name in COMPILED:
            fitting = [folder / (name + suffix) for suffix in importlib.machinery.EXTENSION_SUFFIXES]
            there = [file for file in fitting if file.is_file()]
            if not there:
                raise SystemExit(f"{folder} has no {name} for this Python: {', '.join(f.name for f in fitting)}")
            shutil.copy(there[0], Path(self.build_lib) / "karst")


class Compiled(Distribution):
    def has_ext_modules(self) -> bool:
        return True


setup(
    name="karst",
    version=VERSION,
    description="Exploration policies for cave-flying UAVs: write, fly, compare and learn them",
    packages=["karst"],
    package_data={"karst": ["py.typed"]},
    python_requires=">=3.11",
    install_requires=["numpy"],
    extras_require={"plots": ["matplotlib", "pandas"]},
    cmdclass={"build_py": WithCompiled},
    distclass=Compiled,
)
