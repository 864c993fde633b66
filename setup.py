"""What `pyproject.toml` cannot say: a wheel holds the built web page, which lies outside the packages."""

from __future__ import annotations

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

PAGE = Path("web/dist")


class BuildWithPage(build_py):
    """Builds the packages, and puts the page into `service/web` where `make setup` or `make wheel` has built it."""

    def run(self) -> None:
        super().run()
        if self.editable_mode:  # a checkout serves the page from where it is built
            return
        target = Path(self.build_lib) / "service" / "web"
        shutil.rmtree(target, ignore_errors=True)  # what an earlier build left there
        if (PAGE / "index.html").is_file():
            shutil.copytree(PAGE, target, ignore=shutil.ignore_patterns(".*"))


setup(cmdclass={"build_py": BuildWithPage})
