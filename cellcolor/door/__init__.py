"""The front door: what ``import cellcolor`` offers, over all the other rooms.

Commands are made of the same parts as these functions, and add files, progress and exit codes. Each
module is imported when one of its functions is asked for; none has the name of such a
function, which importing it would overwrite.
"""
