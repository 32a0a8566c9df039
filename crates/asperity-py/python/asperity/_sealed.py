"""Objects that hold what was computed: their attributes cannot be replaced, and their arrays are read-only."""

from __future__ import annotations

import inspect
from abc import ABCMeta
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import frozen, meant


def read_only(value: Any) -> Any:
    """An array, or a tuple or dictionary of some, that cannot be written to; anything else as it is."""
    if isinstance(value, np.ndarray):
        return frozen(value)
    if type(value) is tuple and any(isinstance(one, np.ndarray) for one in value):
        return tuple(read_only(one) for one in value)
    if type(value) is dict and any(isinstance(one, (np.ndarray, tuple)) for one in value.values()):
        return {name: read_only(one) for name, one in value.items()}
    return value


class Spelled(ABCMeta):
    """The type of classes whose misspelt arguments are answered with the nearest one."""

    if not TYPE_CHECKING:  # where it would hide what the classes take

        def __call__(cls, *positional, **named):
            try:
                return super().__call__(*positional, **named)
            except TypeError as error:
                # One that comes from within has an inner frame.
                within = error.__traceback__.tb_next.tb_next if error.__traceback__ and error.__traceback__.tb_next else None
                known = () if within else inspect.signature(cls).parameters
                for unknown in (name for name in named if known and name not in known):
                    raise TypeError(f"{cls.__name__}() takes no argument {unknown!r}{meant(unknown, known)}") from None
                raise

        @property
        def __signature__(cls):
            first, *others = inspect.signature(cls.__init__).parameters.values()
            return inspect.Signature(others)


class Named(metaclass=Spelled):
    """An object whose misspelt attributes are answered with the nearest one."""

    if not TYPE_CHECKING:  # where it would hide misspelt names

        def __getattr__(self, name):
            # What a property says itself goes first.
            if any(name in vars(kind) for kind in type(self).__mro__):
                return object.__getattribute__(self, name)
            known = [] if name.startswith("_") else [one for one in dir(self) if one[0] != "_"]
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}{meant(name, known)}")


class ReadOnlyArrays(Named):
    """A dataclass whose arrays are read-only, in its copies and pickles too."""

    def __post_init__(self) -> None:
        self.__setstate__(self.__dict__)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update({name: read_only(value) for name, value in state.items()})


class Sealed(Named):
    """What does not change once it is made: public attributes cannot be set, and arrays are read-only."""

    def _hold(self, **values: Any) -> None:
        """Sets attributes."""
        self.__dict__.update({name: read_only(value) for name, value in values.items()})

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._hold(**state)

    def __setattr__(self, name: str, value: Any) -> None:
        if not name.startswith("_"):
            raise AttributeError(f"{name} cannot be set: {type(self).__name__} does not change once it is made; work on a copy of its numbers")
        object.__setattr__(self, name, value)

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"{name} cannot be deleted: {type(self).__name__} does not change once it is made")
