"""Pictures: labelled surfaces, topological graphs and the arm, as PNG, SVG or HTML.

What is drawn is worked out without any drawing library (:mod:`cellcolor.pictures.picture`).
:mod:`cellcolor.pictures.static` draws it with Matplotlib, which comes with the extra ``viz``;
:mod:`cellcolor.pictures.viewer` makes a page that draws it with three.js. The arm and the reasons
need the extra ``frontend``.
"""
