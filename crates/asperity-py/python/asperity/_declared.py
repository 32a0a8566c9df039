"""Arguments that are the fields of a dataclass, which functions may share: what a field is declared as says how it is checked.

A field of the type `float` is a number in SI units, `int` a whole number, `bool` True or False, and a word is one of its Literal in
:mod:`asperity._words`. Fields of other types are checked where they are used, and limits by the core.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, fields
from typing import TYPE_CHECKING, Any, ClassVar, ParamSpec, TypeVar, get_args

import numpy as np

from . import _words
from ._arrays import choice, count, meant, number
from ._core import CaseError
from ._parameters import call
from ._sealed import Named
from ._units import bare

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Arguments = ParamSpec("Arguments")
Options = TypeVar("Options")
Answer = TypeVar("Answer")


def _truth(name: str, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_, int)) or value not in (0, 1):
        raise CaseError(f"{name} is {value!r}, but must be True or False")
    return bool(value)


def _of_bodies(name: str, value: Any) -> float | tuple[float, ...]:
    """A number for both bodies, or one for each."""
    value = bare(name, value)
    if np.ndim(value) == 0:
        return number(name, value)
    if np.shape(value) != (2,):
        raise CaseError(f"{name} is {value!r}, but must be a number, or a pair of them, of the body that carries the moving surfaces and of the other")
    return tuple(number(name, one) for one in value)


#: What becomes of a value, by the type of its field.
_CHECKS: dict[str, Callable[[str, Any], Any]] = {
    **{"float": number, "int": count, "bool": _truth, "float | tuple[float, float]": _of_bodies},
    **{name: functools.partial(choice, words=words) for name, words in vars(_words).items() if get_args(words)},
}


def check(given: DataclassInstance) -> None:
    """Replaces the values of the fields by checked ones; a field that may be None stays None."""
    for one in fields(given):
        declared = one.type.__name__ if isinstance(one.type, type) else str(one.type)
        kind, value = declared.removesuffix(" | None"), getattr(given, one.name, None)
        if kind in _CHECKS and not (value is None and kind != declared):
            object.__setattr__(given, one.name, _CHECKS[kind](one.name, value))


class Table(Named):
    """The base of frozen dataclasses whose fields are the keys of a table of the case."""

    __dataclass_fields__: ClassVar[dict[str, Any]]

    def __post_init__(self) -> None:
        check(self)

    def __repr__(self) -> str:
        given = {one.name: (getattr(self, one.name), one.default) for one in fields(self)}
        shown = {name: value for name, (value, usual) in given.items() if isinstance(value, np.ndarray) or value != usual}
        return call(type(self).__name__, shown, sum(one.default is MISSING and not one.kw_only for one in fields(self)))

    @property
    def _keys(self) -> dict[str, Any]:
        """The keys of the table that are given."""
        return {one.name: value for one in fields(self) if (value := getattr(self, one.name)) is not None}


def check_call(name: str, signature: inspect.Signature, positional: Sequence[Any], named: Mapping[str, Any]) -> None:
    """Refuses arguments that a function of this signature does not take, with the nearest one that it does."""
    try:
        signature.bind(*positional, **named)
    except TypeError as error:
        for unknown in (one for one in named if one not in signature.parameters):
            raise TypeError(f"{name}() takes no argument {unknown!r}{meant(unknown, signature.parameters)}") from None
        raise TypeError(f"{name}(): {error}") from None


def arguments_of(options: Callable[Arguments, Options]) -> Callable[[Callable[[Options], Answer]], Callable[Arguments, Answer]]:
    """Makes a function of an `options` object one that takes the fields of the object as its arguments."""
    signature = inspect.signature(options)

    def decorate(function: Callable[[Options], Answer]) -> Callable[Arguments, Answer]:
        @functools.wraps(function)
        def call(*positional: Arguments.args, **named: Arguments.kwargs) -> Answer:
            check_call(function.__name__, signature, positional, named)
            return function(options(*positional, **named))

        answer = inspect.signature(function).return_annotation
        call.__signature__ = signature.replace(return_annotation=answer)  # type: ignore[attr-defined]
        call.options = options  # type: ignore[attr-defined]
        return call

    return decorate
