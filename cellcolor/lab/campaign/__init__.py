"""The cross-validation campaign: every solver compared with every other on random instances.

``draw_case`` makes the instances, ``compare_solvers`` holds the solvers to each other and, on
meshes, to ``vertex_colorings``, a search that never sees the graph; ``shrink`` makes a disagreement
small, ``pool`` does all that for thousands of instances on several processes, ``summary`` counts.
"""
