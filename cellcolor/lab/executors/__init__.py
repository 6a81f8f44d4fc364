"""Where many pieces of work are done: each in a process of its own, here or on a cluster.

``alone`` watches one process, ``workers`` has those of this machine, ``cluster`` those of a Dask
cluster, and ``work`` hands pieces of work to either and takes what came of them.
"""
