"""Digests of what a study solves: the same for the same values, in this process and in the next.

Of a function everything counts that it reaches: its code, closure and defaults, the globals that it names, the functions and classes among
them in turn, modules of the user by their source, installed packages by their version.
"""

from __future__ import annotations

import ast
import collections
import contextlib
import dis
import functools
import hashlib
import importlib
import importlib.metadata
import importlib.util
import os
import sys
import sysconfig
import time
import types
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._core import CaseError
from ._materials import Material
from ._surface import Surface

_INSTALLED = [os.path.join(os.path.realpath(sysconfig.get_path(name)), "") for name in ("stdlib", "platstdlib", "purelib", "platlib")]
#: Attributes of a class that say nothing about what it does.
_OF_CLASSES = {"__dict__", "__weakref__", "__module__", "__doc__", "__firstlineno__", "__static_attributes__", "__annotations__", "__annotate__", "__annotate_func__"}
#: When this program began.
_STARTED = time.time()
#: Names with which a function runs what its code does not show.
_DYNAMIC = {"eval", "exec", "__import__", "import_module"}
#: Names with which a function reads the environment, and files.
_ENVIRONMENT = {"environ", "getenv"}
_READERS = {"open", "loadtxt", "genfromtxt", "fromfile", "memmap", "read_csv", "read_text", "read_bytes", "open_dataset", "open_zarr", "read_file"}


def digest(*values: Any) -> str:
    """The same for the same values."""
    walk = Walk()
    found = _hashed([walk.parts(value) for value in values])
    if walk.unknown:
        raise CaseError(f"a point of the study holds {walk.unknown[0]}, which cannot be sent to another process: give numbers, arrays or functions")
    return found


def _hashed(parts: Any) -> str:
    return hashlib.sha256(repr(parts).encode()).hexdigest()


class Walk:
    """One walk through values and all that they reach."""

    def __init__(self) -> None:
        #: What was reached whose content cannot be known, in words.
        self.unknown: list[str] = []
        #: Files that a function names, and the names of functions that read others.
        self.files: set[str] = set()
        self.readers: set[str] = set()
        #: Names of modules that have another value here than their source gives them, which other processes read; and those where the
        #: source was written while this program runs, so that it is perhaps the newer one.
        self.changed: list[str] = []
        self.older: list[str] = []
        self._sources: dict[str, tuple[dict[str, str], set[str]]] = {}
        # By identity: the digest, or the place of one that is not done yet; and the values, so that none has the identity of another.
        self._done: dict[int, str] = {}
        self._held: list[Any] = []

    def parts(self, value: Any) -> Any:
        """What tells a value from others, in text, numbers and bytes."""
        name = type(value).__qualname__
        if value is None or isinstance(value, (bool, int, float, complex, str, bytes)) or value is Ellipsis:
            if isinstance(value, str) and 0 < len(value) < 4096 and "\0" not in value and os.path.isfile(value):
                self.files.add(os.path.abspath(value))
            return name, value
        if isinstance(value, np.generic):
            return self.parts(value.item()) if not isinstance(value, np.void) else (name, value.tobytes())
        if id(value) not in self._done:
            self._held.append(value)
            self._done[id(value)] = f"cycle {len(self._held)}"
            self._done[id(value)] = _hashed(self._whole(name, value))
        return self._done[id(value)]

    def _whole(self, name: str, value: Any) -> Any:
        if isinstance(value, np.ndarray) and value.dtype.kind != "O":
            return "array", value.dtype.str, value.shape, hashlib.sha256(np.ascontiguousarray(value).tobytes()).digest()
        if isinstance(value, (list, tuple)):
            return name, [self.parts(item) for item in value]
        if isinstance(value, (set, frozenset)):
            return name, sorted(repr(self.parts(item)) for item in value)
        if isinstance(value, Mapping):
            return "mapping", [(self.parts(key), self.parts(value[key])) for key in sorted(value, key=repr)]
        if isinstance(value, Path):
            return name, self.parts(str(value))
        if isinstance(value, Material):
            return name, self.parts(value._given)
        if isinstance(value, Surface):
            return name, self.parts([value.heights, value.size])
        if isinstance(value, functools.partial):
            return name, self.parts([value.func, value.args, value.keywords])
        if isinstance(value, types.MethodType):
            return name, self.parts([value.__func__, value.__self__])
        if isinstance(value, types.FunctionType):
            return self._function(value)
        if isinstance(value, types.CodeType):
            return name, value.co_code, self.parts([value.co_names, value.co_varnames, value.co_freevars, value.co_consts])
        if isinstance(value, types.ModuleType):
            return self._module(value)
        if isinstance(value, type):
            return self._class(value)
        if isinstance(value, (staticmethod, classmethod, functools._lru_cache_wrapper)):
            return name, self.parts(value.__wrapped__)
        if isinstance(value, property):
            return name, self.parts([value.fget, value.fset])
        if is_dataclass(value):
            return name, self.parts(type(value)), self.parts({one.name: getattr(value, one.name, None) for one in fields(value)})
        return self._object(name, value)

    def _function(self, function: types.FunctionType) -> Any:
        module = sys.modules.get(function.__module__ or "")
        if module is not None and module.__name__.partition(".")[0] == __package__:
            return function.__module__, function.__qualname__, _core.__version__
        cells = [cell.cell_contents for cell in function.__closure__ or () if _is_full(cell)]
        given = self.parts([function.__defaults__, function.__kwdefaults__, cells])
        # Code that is compiled at run time may have no module, and that of a script or notebook has no file that counts.
        if module is not None and module.__name__ != "__main__" and not _is_own(module):
            return function.__module__, function.__qualname__, _version(module.__name__), given
        return function.__module__, function.__qualname__, self.parts(function.__code__), given, self._named(function)

    def _named(self, function: types.FunctionType) -> Any:
        """The globals that the code names, attributes of modules among them, and the modules that it imports."""
        codes = list(_codes(function.__code__))
        names = sorted({name for code in codes for name in code.co_names})
        there = function.__globals__
        found = {name: self.parts(there[name]) for name in names if name in there and name != "__builtins__"}
        if dynamic := _DYNAMIC & set(names) - set(there):
            self.unknown.append(f"what {function.__qualname__} runs by {', '.join(sorted(dynamic))}")
        if _ENVIRONMENT & set(names):
            self.unknown.append(f"the variables of the environment that {function.__qualname__} reads")
        if _READERS & set(names) and not self.files:
            self.readers.add(function.__qualname__)
        home = sys.modules.get(function.__module__ or "")
        if home is not None and home.__name__ != "__main__" and _is_own(home):
            self._compare(home, names)
        cells = [cell.cell_contents for cell in function.__closure__ or () if _is_full(cell)]
        modules = [held for held in (*(there.get(name) for name in names), *cells) if isinstance(held, types.ModuleType)]
        modules += [module for code in codes for module in self._imports(code, there)]
        for module in modules:
            found[module.__name__] = self.parts(module)
            if _is_own(module):
                self._compare(module, names)
            for name in names if _is_own(module) else ():
                if name in vars(module):
                    held = vars(module)[name]
                    found[f"{module.__name__}.{name}"] = self.parts(held)
                    if isinstance(held, types.ModuleType) and held not in modules:
                        modules.append(held)
        return sorted(found.items())

    def _compare(self, module: types.ModuleType, names: list[str]) -> None:
        """Notes the names whose value was changed since the module was read: another process reads its source."""
        file = str(module.__file__)
        if file not in self._sources:
            self._sources[file] = _written(file)
        constants, functions = self._sources[file]
        for name in names:
            held, words = vars(module).get(name), ""
            if name in constants and isinstance(held, (bool, int, float, str, tuple)) and repr(held) != constants[name]:
                words = f"{module.__name__}.{name} is {held!r} here, but {constants[name]} in its source"
            elif name in functions and isinstance(held, types.FunctionType) and held.__module__ != module.__name__:
                words = f"{module.__name__}.{name} is a function of {held.__module__} here, but not in its source"
            told = self.changed if os.path.getmtime(file) < _STARTED else self.older
            if words and words not in told:
                told.append(words)

    def _imports(self, code: types.CodeType, there: dict[str, Any]) -> Iterator[types.ModuleType]:
        """The modules that code imports itself."""
        steps = list(dis.get_instructions(code))
        for n, step in enumerate(steps):
            if step.opname != "IMPORT_NAME":
                continue
            level, names = (steps[n - back].argval for back in (2, 1))
            try:
                name = importlib.util.resolve_name("." * level + step.argval, there.get("__package__") or "") if level else step.argval
                module = importlib.import_module(name)
            except Exception:  # a module may fail with any error: the point says so
                self.unknown.append(f"the module {step.argval}")
                continue
            yield module
            for other in names or ():
                if isinstance(held := getattr(module, other, None), types.ModuleType):
                    yield held
                elif f"{name}.{other}" in sys.modules:
                    yield sys.modules[f"{name}.{other}"]

    def _module(self, module: types.ModuleType) -> Any:
        if not _is_own(module):
            return module.__name__, _version(module.__name__)
        source = hashlib.sha256(Path(str(module.__file__)).read_bytes()).digest()
        others: dict[str, Any] = {}
        for held in list(vars(module).values()):
            other = held if isinstance(held, types.ModuleType) else _home(held)
            if other is not None and other is not module and other.__name__ not in others:
                others[other.__name__] = self.parts(other)
        return module.__name__, source, sorted(others.items())

    def _class(self, kind: type) -> Any:
        module = sys.modules.get(kind.__module__)
        if module is not None and module.__name__ != "__main__" and not _is_own(module):
            return kind.__module__, kind.__qualname__, _version(kind.__module__)
        held = {name: self.parts(value) for name, value in vars(kind).items() if name not in _OF_CLASSES and not _is_slot(value)}
        return kind.__module__, kind.__qualname__, self.parts(kind.__bases__), sorted(held.items())

    def _object(self, name: str, value: Any) -> Any:
        """Any other object, by what would be pickled of it."""
        try:
            made = value.__reduce_ex__(2)
        except Exception:  # objects refuse in many ways
            self.unknown.append(f"an object of the type {name}")
            return name
        if isinstance(made, str):
            module = _home(value)
            return name, made, None if module is None else self.parts(module)
        function, arguments, *state = made
        rest = [list(one) if isinstance(one, Iterator) else one for one in state]
        # What makes the object may be one of its own methods.
        how = getattr(function, "__qualname__", type(function).__qualname__)
        return name, self.parts(type(value)), how, self.parts(arguments), self.parts(rest)


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    """Code and the code within it."""
    yield code
    for held in code.co_consts:
        if isinstance(held, types.CodeType):
            yield from _codes(held)


def _home(value: Any) -> types.ModuleType | None:
    """The module that an object names as its own."""
    try:
        return sys.modules.get(str(value.__module__))
    except Exception:  # objects may answer with anything
        return None


def _is_full(cell: Any) -> bool:
    try:
        cell.cell_contents
    except ValueError:  # of a function that is not there yet
        return False
    return True


def _is_slot(value: Any) -> bool:
    return isinstance(value, (types.MemberDescriptorType, types.GetSetDescriptorType))


def _is_own(module: types.ModuleType) -> bool:
    """Whether a module is the user's: neither of Python, nor of this package, nor installed."""
    file = getattr(module, "__file__", None)
    if not isinstance(file, str) or module.__name__.partition(".")[0] == __package__ or not os.path.isfile(file):
        return False
    place = os.path.realpath(file)
    return not any(place.startswith(folder) for folder in _INSTALLED) and not {"site-packages", "dist-packages"} & set(Path(place).parts)


def _written(file: str) -> tuple[dict[str, str], set[str]]:
    """What the source of a module binds once: constants, as text, and functions without decorators."""
    try:
        tree = ast.parse(Path(file).read_bytes())
    except (OSError, SyntaxError, ValueError):  # compiled modules have no source
        return {}, set()
    bound = collections.Counter(name for node in ast.walk(tree) for name in _bound(node))
    constants, functions = {}, set()
    for node in tree.body:
        if isinstance(node, ast.FunctionDef) and not node.decorator_list and bound[node.name] == 1:
            functions.add(node.name)
        targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
        if len(targets) != 1 or not isinstance(targets[0], ast.Name) or bound[targets[0].id] != 1:
            continue
        with contextlib.suppress(ValueError, TypeError, AttributeError):
            constants[targets[0].id] = repr(ast.literal_eval(node.value))  # type: ignore[attr-defined]
    return constants, functions


def _bound(node: ast.AST) -> list[str]:
    """The names that a part of a program gives a value."""
    if isinstance(node, (ast.Import, ast.ImportFrom)):
        return [(one.asname or one.name).partition(".")[0] for one in node.names]
    if isinstance(node, ast.Name) and isinstance(node.ctx, (ast.Store, ast.Del)):
        return [node.id]
    return [node.name] if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)) else []


@functools.lru_cache
def _version(name: str) -> str:
    """The version of the package of a module; of those of Python that of Python."""
    root = name.partition(".")[0]
    if root == __package__:
        return _core.__version__
    told = getattr(sys.modules.get(root), "__version__", None)
    if isinstance(told, str):
        return told
    try:
        return importlib.metadata.version(root)
    except importlib.metadata.PackageNotFoundError:
        return ".".join(map(str, sys.version_info[:2]))
