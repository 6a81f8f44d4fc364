"""``python -m cellcolor`` for where the script ``cellcolor`` is not on the path."""

import sys

from cellcolor.cli import main

sys.exit(main())
