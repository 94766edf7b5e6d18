"""The type stubs name what the module has."""

import ast
import pathlib
import re
import unittest

import roadstereo
from roadstereo import _roadstereo

STUBS = ast.parse(pathlib.Path(roadstereo.__file__).with_name("_roadstereo.pyi").read_text(encoding="utf-8"))


def stub_parameters(function):
    """The names of the parameters, "*" before those that need their names."""
    arguments = function.args
    names = [argument.arg for argument in arguments.args]
    names += ["*"] * bool(arguments.kwonlyargs) + [argument.arg for argument in arguments.kwonlyargs]
    return names + ["**kwargs"] * bool(arguments.kwarg)


def runtime_parameters(function):
    """The same, as the first line of the docstring that pybind11 makes has them."""
    first = function.__doc__.splitlines()[0]
    inside = first[first.index("(") + 1 : first.rindex(") ->")]
    while inside != (without := re.sub(r"[\[(][^\[\]()]*[\])]", "", inside)):  # "Tuple[int, int] = (1, 2)"
        inside = without
    return [re.match(r"\**\w*", part.strip())[0] for part in inside.split(",")] if inside else []


def public(names):
    return {name for name in names if not name.startswith("_")}


class Stubs(unittest.TestCase):
    def test_same_names_in_module(self):
        kinds = (ast.ClassDef, ast.FunctionDef)
        self.assertEqual(public(node.name for node in STUBS.body if isinstance(node, kinds)), public(vars(_roadstereo)))
        self.assertEqual(public(roadstereo.__all__), public(vars(_roadstereo)))

    def test_same_members_of_classes(self):
        for node in STUBS.body:
            if isinstance(node, ast.ClassDef):
                members = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
                self.assertEqual(public(members), public(vars(getattr(_roadstereo, node.name))), node.name)

    def test_same_parameters(self):
        checked = 0
        for node in STUBS.body:
            owner, functions = _roadstereo, [node]
            if isinstance(node, ast.ClassDef):
                owner, functions = getattr(_roadstereo, node.name), node.body
            for stub in functions:
                if not isinstance(stub, ast.FunctionDef) or stub.decorator_list:
                    continue
                self.assertEqual(stub_parameters(stub), runtime_parameters(getattr(owner, stub.name)), stub.name)
                checked += 1
        self.assertGreater(checked, 20)


if __name__ == "__main__":
    unittest.main()
