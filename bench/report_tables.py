# SPDX-License-Identifier: MIT
"""All tables and values of the pages: TABLES and VALUES of bench/report_core.py, filled."""

from report_core import TABLES, VALUES, programs  # noqa: F401
import report_cuda_tests  # noqa: F401
import report_extremes  # noqa: F401
import report_predicates  # noqa: F401
import report_queries  # noqa: F401
import report_motion  # noqa: F401
import report_patches  # noqa: F401
import report_runs  # noqa: F401
import report_peers  # noqa: F401
import report_solids  # noqa: F401
import report_scaling  # noqa: F401
import report_sources  # noqa: F401
import report_pages  # noqa: F401
