"""Builds the extension module by CMake and packs python/sinew around it.

    pip install --no-build-isolation .

compiles for this machine's own instruction set; SINEW_NATIVE=OFF in the environment makes a wheel
that other x86-64-v2 machines can use; SINEW_VIEWER=OFF leaves out the browser view. JOBS limits how
many compilers run at once.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


def version():
    """The project's version, which CMakeLists.txt alone states."""
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(sinew VERSION ([0-9.]+)", text).group(1)


class CMakeBuild(build_ext):
    """Configures and builds the target `sinew_python` in setuptools' temporary folder."""

    def build_extension(self, ext):
        """Leaves the module where setuptools expects it."""
        if shutil.which("cmake") is None or shutil.which("ninja") is None:
            raise RuntimeError("cmake and ninja are needed; `scripts/setup.sh wheel` installs them")
        build = Path(self.build_temp).resolve()
        # The view's page is bundled by Node.js; without it the package lacks sinew.view().
        bundler = "ON" if shutil.which("npm") else "OFF"
        configure = [
            "cmake", "-S", str(ROOT), "-B", str(build), "-G", "Ninja",
            "-DCMAKE_BUILD_TYPE=Release", "-DSINEW_TESTS=OFF", "-DSINEW_BENCHMARKS=OFF",
            f"-DSINEW_VIEWER={os.environ.get('SINEW_VIEWER', bundler)}",
            "-DSINEW_PYTHON=ON", f"-DPython3_EXECUTABLE={sys.executable}",
            f"-DSINEW_NATIVE={os.environ.get('SINEW_NATIVE', 'ON')}",
        ]
        jobs = subprocess.check_output([ROOT / "scripts" / "jobs.sh"], text=True).strip()
        compile_ = ["cmake", "--build", str(build), "--target", "sinew_python",
                    "--parallel", os.environ.get("JOBS", jobs)]
        subprocess.run(configure, check=True)
        subprocess.run(compile_, check=True)
        target = Path(self.get_ext_fullpath(ext.name)).resolve()
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(build / "python" / "sinew" / target.name, target)


setup(
    version=version(),
    package_dir={"": "python"},
    packages=find_packages("python", include=["sinew", "sinew.*"]),
    package_data={"sinew": ["*.pyi", "py.typed"], "sinew.gym": ["scenes/*.yaml"]},
    ext_modules=[Extension("sinew._core", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    zip_safe=False,
)
