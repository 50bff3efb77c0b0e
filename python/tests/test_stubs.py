"""The type stubs match the compiled module."""

import ast
import inspect
from pathlib import Path

import pytest
import sinew
import sinew.gym
import sinew.sweep
from sinew import _core

STUB = ast.parse((Path(sinew.__file__).parent / "_core.pyi").read_text(encoding="utf-8"))
CLASSES = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in STUB.body if isinstance(node, ast.FunctionDef)}


def public(names):
    """Names without a leading underscore."""
    return {name for name in names if not name.startswith("_")}


def parameters(node):
    """Parameters of a stubbed function as (name, kind, default), without self."""
    plain = node.args.args
    defaults = [None] * (len(plain) - len(node.args.defaults)) + node.args.defaults
    found = [(a.arg, "plain", d) for a, d in zip(plain, defaults)]
    found += [(a.arg, "keyword", d) for a, d in zip(node.args.kwonlyargs, node.args.kw_defaults)]
    return [
        (name, kind, None if default is None else ast.literal_eval(default))
        for name, kind, default in found
        if name != "self"
    ]


def runtime_parameters(function):
    """Parameters of a compiled function, from the signature in its docstring."""
    found = []
    for parameter in inspect.signature(function).parameters.values():
        if parameter.name == "self":
            continue
        kind = "keyword" if parameter.kind is parameter.KEYWORD_ONLY else "plain"
        empty = parameter.default is parameter.empty
        found.append((parameter.name, kind, None if empty else parameter.default))
    return found


def test_the_same_names():
    assert public(CLASSES) | public(FUNCTIONS) == {
        name for name in public(dir(_core)) if callable(getattr(_core, name))
    }


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_the_same_members(name):
    stub = CLASSES[name]
    cls = getattr(_core, name)
    functions = {n.name for n in stub.body if isinstance(n, ast.FunctionDef)}
    assert public(functions) == public(vars(cls))
    bases = [base.id for base in stub.bases]
    assert bases == [base.__name__ for base in cls.__bases__ if base.__name__ != "pybind11_object"]


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_the_same_kinds_of_members(name):
    cls = getattr(_core, name)
    for node in CLASSES[name].body:
        if not isinstance(node, ast.FunctionDef) or node.name.startswith("_"):
            continue
        decorators = [ast.unparse(decorator) for decorator in node.decorator_list]
        member = vars(cls)[node.name]
        if decorators == ["staticmethod"]:
            assert isinstance(member, staticmethod), node.name
            continue
        assert isinstance(member, property) == bool(decorators), node.name
        if f"{node.name}.setter" in decorators:
            assert member.fset is not None, node.name
    settable = {n for n, member in vars(cls).items() if getattr(member, "fset", None) is not None}
    stubbed = {
        node.name
        for node in CLASSES[name].body
        if isinstance(node, ast.FunctionDef)
        and any(ast.unparse(d).endswith(".setter") for d in node.decorator_list)
    }
    assert settable == stubbed


def methods():
    """Every stubbed method and function with a signature."""
    for name, node in FUNCTIONS.items():
        yield name, node, getattr(_core, name)
    for name, stub in CLASSES.items():
        for node in stub.body:
            if isinstance(node, ast.FunctionDef) and not node.decorator_list:
                if not node.name.startswith("__"):
                    yield f"{name}.{node.name}", node, getattr(getattr(_core, name), node.name)


@pytest.mark.parametrize("name,node,function", [pytest.param(*each, id=each[0]) for each in methods()])
def test_the_same_parameters(name, node, function):
    assert parameters(node) == runtime_parameters(function)


@pytest.mark.parametrize(
    "name", ["Ramp", "Sine", "Steps", "Samples", "Circle", "Polyline", "Trajectory"]
    + ["InverseController", "BendingModulus", "BendingActuator", "BendingMotion"]
)
def test_the_same_parameters_of_constructors(name):
    init = next(n for n in CLASSES[name].body if getattr(n, "name", "") == "__init__")
    spelled = getattr(_core, name).__text_signature__
    stub = f"({ast.unparse(init.args)})".replace("self, ", "$self, ")
    without_types = []
    for parameter, kind, default in parameters(init):
        if kind == "keyword" and "*" not in without_types:
            without_types.append("*")
        without_types.append(parameter if default is None and "=" not in stub else parameter)
    names = [part.split("=")[0].strip() for part in split_arguments(spelled)]
    assert names == without_types


def split_arguments(signature):
    """The arguments of "(a, b=(1, 2))"; commas in parentheses do not count."""
    parts, depth = [""], 0
    for character in signature[1:-1]:
        depth += {"(": 1, ")": -1}.get(character, 0)
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return parts


@pytest.mark.parametrize("module", [sinew, sinew.collision, sinew.gym, sinew.pcc, sinew.qp, sinew.render, sinew.sweep], ids=lambda module: module.__name__)
def test_everything_public_has_a_docstring(module):
    for name in module.__all__:
        member = getattr(module, name)
        if name.startswith("__"):
            continue
        assert member.__doc__, name
        if inspect.isclass(member):
            for key, value in vars(member).items():
                if not key.startswith("_") and (callable(value) or isinstance(value, property)):
                    assert value.__doc__, f"{name}.{key}"


def test_package_is_marked_as_typed():
    assert (Path(sinew.__file__).parent / "py.typed").exists()
