"""Functions whose arguments are the fields of a dataclass: several functions share one declaration of their arguments."""

from __future__ import annotations

import difflib
import functools
import inspect
from collections.abc import Callable
from typing import ParamSpec, TypeVar

Arguments = ParamSpec("Arguments")
Options = TypeVar("Options")
Answer = TypeVar("Answer")


def arguments_of(options: Callable[Arguments, Options]) -> Callable[[Callable[[Options], Answer]], Callable[Arguments, Answer]]:
    """Makes a function of an `options` object one that takes the fields of the object as its arguments."""
    signature = inspect.signature(options)

    def decorate(function: Callable[[Options], Answer]) -> Callable[Arguments, Answer]:
        @functools.wraps(function)
        def call(*positional: Arguments.args, **named: Arguments.kwargs) -> Answer:
            try:
                signature.bind(*positional, **named)
            except TypeError as error:
                unknown = [name for name in named if name not in signature.parameters]
                raise TypeError(_wrong(function.__name__, unknown[0]) if unknown else f"{function.__name__}(): {error}") from None
            return function(options(*positional, **named))

        def _wrong(called: str, name: str) -> str:
            near = difflib.get_close_matches(name, signature.parameters, 1)
            return f"{called}() takes no argument {name!r}" + (f"; did you mean {near[0]!r}?" if near else "")

        answer = inspect.signature(function).return_annotation
        call.__signature__ = signature.replace(return_annotation=answer)  # type: ignore[attr-defined]
        call.options = options  # type: ignore[attr-defined]
        return call

    return decorate
