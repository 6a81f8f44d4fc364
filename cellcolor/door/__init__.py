"""The front door: what ``import cellcolor`` offers, over all the other rooms.

Commands call these functions, and add files, progress and exit codes. A module is imported
when one of its functions is first used. No module has the name of such a function, because
importing the module would overwrite the function.
"""
