"""``report.html``: one page on a planned motion, complete in itself.

Texts and tables are written here (:mod:`.cards`); what moves is drawn by scripts of our own that
are put into the page (``*.js``), from arrays that :mod:`.viewer_data` prepares.
"""
