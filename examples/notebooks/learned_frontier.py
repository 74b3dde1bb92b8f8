"""A linear policy whose weights were learned: see train.py and learning_a_policy.ipynb."""

import numpy as np

import karst
from frontier_features import NAMES, Features, decide

WEIGHTS = {
    "path": -1.0,
    "turn": -0.683,
    "under_way": -0.5096,
    "unknown": -0.5721,
    "size": 1.1086,
    "gain": 0.8004,
    "rate": -0.8677,
    "off_path": 1.1139,
    "deeper": 0.8942,
    "up": 0.08,
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
