"""Builds the wheel, with the command line tool: python3 -m build --wheel --no-isolation python

CMake builds both in the folder that ROADSTEREO_BUILD names, or in build-wheel.
"""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("ROADSTEREO_BUILD", ROOT / "build-wheel")).resolve()


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        options = ["-DROADSTEREO_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}"]
        subprocess.run(["cmake", "-S", ROOT, "-B", BUILD, *options], check=True)
        targets = ["roadstereo_python", "roadstereo_program"]
        subprocess.run(["cmake", "--build", BUILD, "--parallel", "--target", *targets], check=True)
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        self.copy_file(BUILD / "python" / "roadstereo" / target.name, target)


setup(
    version=re.search(r"project\(roadstereo VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1],
    ext_modules=[Extension("roadstereo._roadstereo", [])],
    cmdclass={"build_ext": CMakeBuild},
    data_files=[("bin", [str(BUILD / "bin" / "roadstereo")])],
)
