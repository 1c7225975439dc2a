# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Input that lies beside the checkout, or where CAPLET_DATA says."""
import os
import pathlib

import pytest

FOLDER = pathlib.Path(os.environ.get("CAPLET_DATA") or pathlib.Path(__file__).resolve().parents[3] / "shared/data")


def data(*parts):
    """The path of a shared file. Where it is not there, the test is skipped, or fails if CAPLET_REQUIRE_DATA is set."""
    path = FOLDER.joinpath(*parts)
    if not path.exists():
        (pytest.fail if os.environ.get("CAPLET_REQUIRE_DATA") else pytest.skip)("needs the shared data folder (beside the checkout, or CAPLET_DATA)")
    return str(path)
