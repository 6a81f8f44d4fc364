"""Pictures: labelled surfaces, topological graphs and the arm, as PNG, SVG or HTML.

What is drawn is worked out without any drawing library (:mod:`cellcolor.pictures.picture`);
:mod:`cellcolor.pictures.static` draws it with Matplotlib and
:mod:`cellcolor.pictures.interactive` with plotly. Those two need the extra
``viz``; the arm and the reasons need ``frontend``.
"""
