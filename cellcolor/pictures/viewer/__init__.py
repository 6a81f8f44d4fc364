"""The page on which pictures are turned with the mouse: one file that loads nothing.

:mod:`.page` makes JSON of a picture, and puts texts, styles, scripts and data together.
The scripts (``*.js``) draw with three.js, which is vendored as ``three.min.js`` (CONTRIBUTING.md
says how it is made).
"""
