"""From joint solutions at the vertices of a mesh to a labelled surface, without a robot.

What comes in: a triangle mesh and, for each vertex, the configurations that reach it, in any order.
What goes out: :class:`~cellcolor.configurations.labelling.Labelling`, a labelled surface and what
was doubtful about it. Begin with :func:`~cellcolor.configurations.labelling.from_configurations`;
``matching`` decides which configurations at the two ends of a mesh edge belong together, and
``components`` makes colors of what belongs together.
"""
