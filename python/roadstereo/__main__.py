"""Runs the command line tool: python3 -m roadstereo COMMAND …"""

import os
import pathlib
import shutil
import sys


def find_program() -> str:
    """Return the path of the command line tool: in the prefix or the build folder of this package, else in PATH."""
    for folder in list(pathlib.Path(__file__).resolve().parents)[1:5]:
        program = folder / "bin" / "roadstereo"
        if program.is_file() and os.access(program, os.X_OK):
            return str(program)
    found = shutil.which("roadstereo")
    if found is None:
        sys.exit("the command line tool roadstereo is neither beside the Python package nor in PATH")
    return found


if __name__ == "__main__":
    program = find_program()
    os.execv(program, [program, *sys.argv[1:]])
