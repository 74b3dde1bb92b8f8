"""A linear policy whose weights were learned: see train.py and learning_a_policy.ipynb."""

import numpy as np

import karst
from frontier_features import NAMES, Features, decide

WEIGHTS = {
    "path": -1.0,
    "turn": -0.1228,
    "under_way": 0.0401,
    "unknown": -0.567,
    "size": 0.3405,
    "gain": 0.1518,
    "rate": -0.0749,
    "off_path": -0.0035,
    "deeper": 0.3283,
    "up": 0.3514,
}


class LearnedFrontier(karst.Policy):
    """Flies to the frontier with the highest weighted sum of features; the weights were learned."""

    def __init__(self):
        self.features = Features()
        self.weights = np.array([WEIGHTS[name] for name in NAMES])

    def decide(self, request):
        return decide(self.features, self.weights, request)

    def save(self):
        return self.features.flown

    def restore(self, saved):
        self.features.flown = saved
