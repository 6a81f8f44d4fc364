"""``report.html``: one page on a planned motion, complete in itself.

Texts and tables are written here (:mod:`.cards`); what is drawn comes from
:mod:`.motion_data`, and :mod:`cellcolor.pictures.viewer` draws it.
"""
