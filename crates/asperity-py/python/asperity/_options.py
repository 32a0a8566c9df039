"""Functions whose arguments are the fields of a dataclass: several functions share one declaration of their arguments."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ParamSpec, TypeVar

from ._arrays import meant

Arguments = ParamSpec("Arguments")
Options = TypeVar("Options")
Answer = TypeVar("Answer")


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
