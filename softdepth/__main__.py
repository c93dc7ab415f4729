"""``python -m softdepth``: the command line."""

import sys

from softdepth.cli import main

sys.exit(main())
