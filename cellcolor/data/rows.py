"""Arrays in values: of one kind and shape, finite, copies that nobody can change."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from cellcolor.errors import InputError


def rows_of(content: Any, width: int, member: str) -> NDArray[np.float64]:
    """An array (k, width) of finite float64.

    Raises:
        InputError: it has another shape, or something in it is no finite number.
    """
    array = _array(content, np.float64, "iuf", "numbers", member)
    if array.size == 0:
        array = array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise InputError(None, member, f"each entry needs {width} numbers")
    return _finite(array, member)


def numbered_rows(content: Any, member: str) -> NDArray[np.float64]:
    """An array (k, m) of float64, NaN allowed, of whatever width.

    Raises:
        InputError: it has another shape, or something in it is infinite or no number.
    """
    array = _array(content, np.float64, "iuf", "numbers", member)
    if array.ndim != 2:
        raise InputError(None, member, "must be rows of numbers")
    bad = np.argwhere(np.isinf(array))
    if len(bad):
        raise InputError(None, f"{member}[{bad[0][0]}][{bad[0][1]}]", "is infinite")
    return _settled(array)


def rows_of_three(content: Any, member: str) -> NDArray[np.float64]:
    """An array (k, 3) of finite float64; see :func:`rows_of`."""
    return rows_of(content, 3, member)


def numbers(content: Any, member: str) -> NDArray[np.float64]:
    """An array (k,) of finite float64.

    Raises:
        InputError: it has another shape, or something in it is no finite number.
    """
    return _finite(_flat(_array(content, np.float64, "iuf", "numbers", member), member), member)


def integers(content: Any, member: str) -> NDArray[np.int64]:
    """An array (k,) of int64.

    Raises:
        InputError: it has another shape, or something in it is no integer.
    """
    return _settled(_flat(_array(content, np.int64, "iu", "integers", member), member))


def truths(content: Any, member: str) -> NDArray[np.bool_]:
    """An array (k,) of true and false.

    Raises:
        InputError: it has another shape, or something in it is neither.
    """
    return _settled(_flat(_array(content, np.bool_, "b", "true or false", member), member))


def _array(content: Any, kind: type, kinds: str, text: str, member: str) -> NDArray[Any]:
    try:
        array = np.array(content)
    except ValueError as error:  # rows of different lengths
        raise InputError(None, member, f"must be rows of {text} of one length") from error
    if array.size and array.dtype.kind not in kinds:
        raise InputError(None, member, f"must be {text}")
    return array.astype(kind)


def _flat(array: NDArray[Any], member: str) -> NDArray[Any]:
    if array.ndim != 1:
        raise InputError(None, member, "must be one row")
    return array


def _finite(array: NDArray[Any], member: str) -> NDArray[Any]:
    bad = np.argwhere(~np.isfinite(array))
    if len(bad):
        place = "".join(f"[{number}]" for number in bad[0])
        raise InputError(None, f"{member}{place}", "is not a finite number")
    return _settled(array)


def _settled(array: NDArray[Any]) -> NDArray[Any]:
    array.setflags(write=False)
    return array
