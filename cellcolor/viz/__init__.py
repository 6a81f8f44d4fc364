"""Pictures: labelled surfaces, topological graphs and the arm, as PNG, SVG or HTML.

What is drawn is worked out without any drawing library (:mod:`cellcolor.viz.picture`);
:mod:`cellcolor.viz.static` draws it with Matplotlib and :mod:`cellcolor.viz.interactive` with
plotly. Those two need the extra ``viz``; the arm and the reasons need ``frontend``.
"""
