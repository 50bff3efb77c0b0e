"""The modules of the package do not import each other in a circle."""

import ast
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[1] / "sinew"


def imported(name, is_package, tree, names):
    """Modules among `names` that a module imports, at its top or in its functions. A package that is only entered to reach
    one of its modules does not count: `from ..errors import Error` imports sinew.errors, not sinew."""
    package = name if is_package else name.rpartition(".")[0]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (one.name for one in node.names if one.name in names)
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[:len(package.split(".")) + 1 - node.level] if node.level else []
            source = ".".join([*base, *([node.module] if node.module else [])])
            for one in node.names:
                inner = f"{source}.{one.name}"
                if inner in names:
                    yield inner
                elif source in names and not (source == "sinew" and one.name == "_core"):
                    yield source


def circle(edges):
    """A circle of modules, or an empty list."""
    done, path = set(), []

    def visit(name):
        if name in path:
            return path[path.index(name):] + [name]
        if name in done:
            return []
        path.append(name)
        found = next((found for other in sorted(edges[name]) if (found := visit(other))), [])
        path.pop()
        done.add(name)
        return found

    return next((found for name in sorted(edges) if (found := visit(name))), [])


def modules(root):
    found = {}
    for path in root.rglob("*.py"):
        words = [root.name, *path.relative_to(root).with_suffix("").parts]
        found[".".join(words[:-1] if words[-1] == "__init__" else words)] = path
    return found


def edges_of(root):
    found = modules(root)
    return {name: {other for other in imported(name, path.name == "__init__.py", ast.parse(path.read_text()), found) if other != name}
            for name, path in found.items()}


def test_there_is_no_circle():
    edges = edges_of(ROOT)
    assert "sinew.errors" in edges["sinew.control.robot"] and "sinew.sweep.runner" in edges["sinew.sweep.child"]
    assert circle(edges) == []


def test_circles_are_found(tmp_path):
    package = tmp_path / "sinew"
    (package / "inner").mkdir(parents=True)
    (package / "__init__.py").write_text("from .one import a\n")
    (package / "inner/__init__.py").write_text("")
    (package / "one.py").write_text("from .inner import two\n")
    (package / "inner/two.py").write_text("from . import three\n")
    (package / "inner/three.py").write_text("def later():\n    from ..one import a\n")
    assert circle(edges_of(package)) == ["sinew.one", "sinew.inner.two", "sinew.inner.three", "sinew.one"]
    (package / "inner/three.py").write_text("import ast\n")
    assert circle(edges_of(package)) == []
