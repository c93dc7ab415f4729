"""``python -m softdepth``: the command line."""

import sys

from softdepth.cli.app import main

sys.exit(main())
