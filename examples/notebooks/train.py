#!/usr/bin/python3
"""Learns the weights of a linear policy in karst.Environment with an evolution strategy, in numpy only.

    train.py --minutes 25 --out learned_weights.json

The strategy draws candidates around a mean, flies all of a generation through the same caves with the same seeds,
and moves the mean towards the better half, weighted by rank. The score of a flight is the mean of the explored
volume over the flight time, as coverage_auc has it, over that of the starting weights in the same cave.
"""

import argparse
import json
import resource
import time
from pathlib import Path

import numpy as np

import karst
from frontier_features import NAMES, NEAREST_ONLY, Features, decide

PRESETS = ("medium", "vertical", "maze")
CAVE_SEEDS = (101, 102, 103, 104)
FLIGHT_S = 180.0  # as in the comparison
EPISODE_S = 120.0  # then the way home is about to begin, on which a policy decides nothing


def caves(folder, presets=PRESETS, seeds=CAVE_SEEDS):
    """The training caves, made if they are not there: lists by preset."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    for preset in presets:
        for seed in seeds:
            if not Path(folder, f"{preset}-{seed}.info").exists():
                karst.run_karst(["cave", "generate", "--preset", preset, "--seed", str(seed), "--out",
                                 f"{folder}/{preset}-{seed}"])
    return [[Path(folder, f"{preset}-{seed}.info") for seed in seeds] for preset in presets]


def volume_for_the_rest(before, after):
    """New volume times the time for which it counts until the flight must end: m3 s."""
    return karst.environment.new_volume(before, after) * max(0.0, FLIGHT_S - after.time_s)


def fly(environment, weights, cave, seed, episode_s=EPISODE_S):
    """The mean over the flight time of the volume explored, m3."""
    _, info = environment.reset(seed=seed, options={"cave": cave})
    features, total, ended = Features(), 0.0, False
    while not ended and info["request"].time_s < episode_s:
        answer = decide(features, weights, info["request"])
        _, reward, terminated, truncated, info = environment.step(answer)
        total, ended = total + reward, terminated or truncated
    return total / FLIGHT_S


def shares(n):
    """Weights of the better half by rank, as in the CMA evolution strategy: n numbers with the sum 1."""
    raw = np.maximum(0, np.log(n / 2 + 0.5) - np.log(np.arange(1, n + 1)))
    return raw / raw.sum()


def train(groups, *, generations=8, minutes=np.inf, population=10, sigma=0.7, decay=0.9, flights=2, seed=1,
          episode_s=EPISODE_S, report=print, keep=None):
    """Weights, and a row for each generation. ``flights``: caves that each candidate flies through.

    ``minutes``: no generation begins that would not end within this time of the processor, as far as known.
    ``keep``: called with weights and rows after each generation.
    """
    rng = np.random.default_rng(seed)
    mean, curve, begin_s, flown = NEAREST_ONLY.copy(), [], cpu_s(), 0
    with karst.Environment(groups[0][0], time_s=FLIGHT_S, reward=volume_for_the_rest) as environment:
        for generation in range(generations):
            used_s = cpu_s() - begin_s
            if curve and used_s * (1 + 1 / len(curve)) > 60 * minutes:
                break
            steps = rng.normal(size=(population // 2, len(NAMES)))
            steps = np.concatenate([steps, -steps])  # mirrored: less noise
            steps[:, 0] = 0  # only ratios matter: a metre of path keeps its price
            candidates = mean + sigma * steps
            order = (generation * flights + np.arange(flights)) % len(groups)
            courses = [(groups[i][rng.integers(len(groups[i]))], int(rng.integers(1000, 10**6))) for i in order]
            scores = np.array([
                [fly(environment, w, cave, s, episode_s) for cave, s in courses]
                for w in [NEAREST_ONLY, *candidates]
            ])
            flown += scores.size
            gains = (scores[1:] / np.maximum(scores[0], 1e-9) - 1).mean(axis=1)
            best = np.argsort(-gains)
            mean = mean + sigma * shares(population) @ steps[best]
            curve.append({
                "generation": generation + 1, "sigma": round(sigma, 4), "flights": flown,
                "cpu_minutes": round((cpu_s() - begin_s) / 60, 2),
                "caves": [c.stem for c, _ in courses], "flight_seeds": [s for _, s in courses],
                "start_m3": np.round(scores[0], 1).tolist(), "gains": np.round(np.sort(gains)[::-1], 4).tolist(),
                "mean": np.round(mean, 4).tolist(),
            })
            report(f"generation {generation + 1}: {100 * gains.mean():+.1f} % on average, "
                   f"{100 * gains.max():+.1f} % the best; {flown} flights, {curve[-1]['cpu_minutes']:.1f} min")
            sigma *= decay
            if keep is not None:
                keep(mean, curve)
    return mean, curve


def cpu_s():
    """Processor time of this process and of the flights that have ended."""
    return sum(u.ru_utime + u.ru_stime
               for u in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


def policy_text(weights):
    """The file of a policy with these weights: it needs frontier_features.py beside it."""
    numbers = "".join(f'    "{name}": {weight!r},\n' for name, weight in weights.items())
    return f'''"""A linear policy whose weights were learned: see train.py and learning_a_policy.ipynb."""

import numpy as np

import karst
from frontier_features import NAMES, Features, decide

WEIGHTS = {{
{numbers}}}


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
'''


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=25, help="of processor time")
    parser.add_argument("--generations", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--caves", default="caves/training")
    parser.add_argument("--out", default="learned_weights.json")
    a = parser.parse_args()
    begin = time.time()
    settings = {"population": 10, "sigma": 0.7, "decay": 0.9, "flights": 2, "seed": a.seed}
    groups = caves(a.caves)

    def report(line):
        print(line, flush=True)

    def keep(weights, curve):
        record = {
            "weights": dict(zip(NAMES, np.round(weights, 4).tolist())),
            "start": dict(zip(NAMES, NEAREST_ONLY.tolist())),
            "settings": settings | {"presets": PRESETS, "cave_seeds": CAVE_SEEDS, "flight_s": FLIGHT_S,
                                    "episode_s": EPISODE_S, "vehicle": "lidar_uav", "karst": karst.__version__},
            "budget": {"flights": curve[-1]["flights"], "cpu_minutes": curve[-1]["cpu_minutes"],
                       "wall_minutes": round((time.time() - begin) / 60, 1), "cores": 1},
            "curve": curve,
        }
        Path(a.out).write_text(json.dumps(record, indent=1) + "\n")

    train(groups, generations=a.generations, minutes=a.minutes, report=report, keep=keep, **settings)


if __name__ == "__main__":
    main()
