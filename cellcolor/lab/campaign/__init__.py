"""The cross-validation campaign: every solver compared with every other on random instances.

``agreement`` holds the solvers to each other and, on meshes, to a search that never sees the
graph; ``shrink`` makes a disagreement small, ``pool`` does all that for thousands of instances.
"""
