"""The page on which pictures are turned with the mouse: one file that loads nothing.

:mod:`.data` makes JSON of a picture, :mod:`.page` puts texts, styles, scripts and data together.
The scripts (``*.js``) draw with three.js, which is vendored as ``three.min.js`` (CONTRIBUTING.md
says how it is made).
"""
