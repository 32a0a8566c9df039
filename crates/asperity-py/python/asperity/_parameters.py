"""What an object was made with, as its attributes: `ramp.duration`, `sphere.radius`, `wlf.c1`."""

from __future__ import annotations

from typing import Any, Generic, Protocol, TypeVar, cast, overload

Value = TypeVar("Value")


class Parametrised(Protocol):
    """An object that knows what it was made with."""

    @property
    def _parameters(self) -> dict[str, Any]:
        """The values by the names of the parameters."""


class Parameter(Generic[Value]):
    """An attribute that is one of the parameters; an object that was made without it does not have it."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, made: None, owner: type) -> Parameter[Value]: ...
    @overload
    def __get__(self, made: Parametrised, owner: type) -> Value: ...
    def __get__(self, made: Parametrised | None, owner: type) -> Parameter[Value] | Value:
        if made is None:
            return self
        known = made._parameters
        if self._name not in known:
            has = f"was made with {', '.join(known)}" if known else "has no parameters"
            raise AttributeError(f"{made!r} has no {self._name!r}; it {has}")
        return cast(Value, known[self._name])


def parameters(kind: type[Value], number: int) -> list[Parameter[Value]]:
    """As many attributes of this kind, which take the names that they are given."""
    return [Parameter[Value]() for _ in range(number)]


def call(name: str, parameters: dict[str, Any], positional: int = 0) -> str:
    """The call that makes the object, the first parameters without their names."""
    told = {key: f"<array of {value.shape}>" if hasattr(value, "shape") else repr(value) for key, value in parameters.items()}
    words = [value if n < positional else f"{key}={value}" for n, (key, value) in enumerate(told.items())]
    return f"{name}({', '.join(words)})"
