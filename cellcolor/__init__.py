"""cellcolor: the fewest lift-offs of a robot arm over a surface, with a proof.

The problem is that of Yang, Valls Miro, Lai, Wang and Xiong, "Cellular Decomposition for
Non-repetitive Coverage Task with Minimum Discontinuities" (2020). Terms are the paper's::

    import cellcolor

    result = cellcolor.solve("wok", time_limit=60)  # a scene, a surface, an instance
    print(result)
    result.plot("wok.html")

What is public is listed in ``__init__.pyi``, which type checkers and editors read as well, and
imported when it is first used (PEP 562): whoever imports the package waits for no library.
"""

with open(f"{__path__[0]}/__init__.pyi", encoding="utf-8") as _stub:  # noqa: PTH123, slow to import
    _ROOM_OF = {line.split()[-1]: line.split()[1] for line in _stub if line.startswith("from ")}

__all__ = sorted(_ROOM_OF)


def __getattr__(name: str) -> object:
    if name not in _ROOM_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(_ROOM_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
