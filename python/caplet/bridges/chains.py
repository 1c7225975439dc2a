# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What u is along chains of capsules."""
import numpy as np


def along(points):
    """u at both ends of the capsules between points (n, 3), as (n - 1, 2): from 0 to 1 by length; by number where there is none."""
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(np.asarray(points, np.float64), axis=0), axis=1))])
    share = way / way[-1] if way[-1] > 0 else np.linspace(0, 1, len(way))
    return np.stack([share[:-1], share[1:]], axis=1)
