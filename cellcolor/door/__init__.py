"""The front door: what ``import cellcolor`` offers, over all the other rooms.

The command line uses the same functions. Each module is imported when one of its functions is
asked for; none has the name of such a function, which importing it would overwrite.
"""
