# SPDX-License-Identifier: GPL-3.0-or-later
"""Proximal policy optimisation (Schulman et al., 2017) in Debian's torch: a robot learns to reach goals among people.

    python3 ppo.py train policy.npz [--minutes 10]     writes the policy, and policy.csv with the curve;
                                                       --before FILE goes on from another policy
    python3 ppo.py test policy.npz [--episodes 500]    success in rooms that it has not seen

Needs python3-numpy, python3-torch and, for speed, libopenblas0-pthread.
"""

import argparse
import resource
import tempfile
import time

import numpy as np
import torch
from policy import Features, Policy
from rooms import write
from torch import nn

import ispace

TASK = {
    "people": [4, 10],
    "goal": {"distance": [3, 8], "detour": 1.5, "radius": 0.3},
    "rewards": [
        {"signal": "way_progress", "weight": 0.5},
        {"signal": "reached", "weight": 3},
        {"signal": "collision", "weight": -6},
        {"signal": "clearance", "weight": -0.1, "below": 0.5},
        {"signal": "clearance", "weight": -0.3, "below": 0.3},
        {"signal": "step", "weight": -0.01},
    ],
    "truncations": [{"signal": "steps", "above": 399}],
}
WORLDS, STEPS, EPOCHS, PARTS = 512, 64, 3, 8
GAMMA, LAMBDA, CLIP = 0.99, 0.95, 0.2


def net(inputs, outputs, gain):
    layers = []
    for wide in (128, 64):
        layers += [nn.Linear(inputs, wide), nn.Tanh()]
        inputs = wide
    layers.append(nn.Linear(inputs, outputs))
    for layer in layers[::2]:
        nn.init.orthogonal_(layer.weight, 1.4)
        nn.init.zeros_(layer.bias)
    nn.init.orthogonal_(layers[-1].weight, gain)
    return nn.Sequential(*layers)


class Agent(nn.Module):
    def __init__(self, inputs):
        super().__init__()
        self.actor, self.critic = net(inputs, 2, 0.01), net(inputs, 1, 1)
        self.actor[-1].bias.data[:] = torch.tensor([0.4, 0.0])  # goes ahead at first
        self.log_std = nn.Parameter(torch.tensor([-0.7, -0.5]))

    def draws(self, x):
        return torch.distributions.Normal(self.actor(x), self.log_std.exp())

    def load(self, file):
        with np.load(file) as data, torch.no_grad():
            for i, layer in enumerate(self.actor[::2]):
                layer.weight.copy_(torch.from_numpy(data[f"w{i}"]))
                layer.bias.copy_(torch.from_numpy(data[f"b{i}"]))
            self.log_std[:] = -1.5

    def save(self, file):
        layers = self.actor[::2]
        arrays = {f"w{i}": layer.weight.detach().numpy() for i, layer in enumerate(layers)}
        arrays.update({f"b{i}": layer.bias.detach().numpy() for i, layer in enumerate(layers)})
        np.savez(file, **arrays)


def spent():
    """Seconds of processor time of this process and simrun, once that has ended."""
    return sum(resource.getrusage(who).ru_utime + resource.getrusage(who).ru_stime
               for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def train(file, minutes, rooms, seed, before):
    torch.manual_seed(seed)
    torch.set_num_threads(1)  # the nets are small, and simrun takes the other core
    with tempfile.TemporaryDirectory() as folder:
        env = ispace.VectorEnv(write(folder, 1, rooms), WORLDS, task=TASK, autoreset_mode="SAME_STEP", copy=False)
    features = Features(WORLDS)
    agent = Agent(features.size)
    rate = 3e-4 if before else 7e-4
    if before:
        agent.load(before)
    optimiser = torch.optim.Adam(agent.parameters(), rate, eps=1e-5)
    begin, updates, steps = time.time(), 0, 0
    lists = {key: np.zeros((STEPS, WORLDS), np.float32) for key in ("reward", "value", "next", "log")}
    seen = np.zeros((STEPS, WORLDS, features.size), np.float32)
    acted = np.zeros((STEPS, WORLDS, 2), np.float32)
    ended = np.zeros((STEPS, WORLDS), bool)
    curve = open(file.replace(".npz", ".csv"), "w", encoding="utf-8")
    curve.write("minutes,processor_minutes,steps,episodes,success,collision,length\n")
    now = features(env.reset(seed=seed)[0])
    while (share := (time.time() - begin) / (60 * minutes)) < 1:
        results = []
        with torch.no_grad():
            for t in range(STEPS):
                x = torch.from_numpy(now)
                drawn = agent.draws(x)
                action = drawn.sample()
                seen[t], acted[t] = now, action
                lists["log"][t] = drawn.log_prob(action).sum(1)
                lists["value"][t] = agent.critic(x)[:, 0]
                observations, reward, over, cut, infos = env.step(acted[t].clip(-1, 1))
                lists["reward"][t], ended[t] = reward, over | cut
                if cut.any():  # what would have followed still counts
                    final = features.last(infos["final_obs"])
                    values = agent.critic(torch.from_numpy(final[cut]))[:, 0].numpy()
                    lists["reward"][t, cut] += GAMMA * values
                if ended[t].any():
                    rows = infos["_episode"]
                    results += zip(infos["success"][rows], infos["collision"][rows], infos["episode"]["l"][rows])
                now = features(observations, ended[t])
            after = agent.critic(torch.from_numpy(now))[:, 0].numpy()
        # Generalised advantages.
        advantage, last = np.zeros_like(lists["value"]), np.zeros(WORLDS, np.float32)
        for t in reversed(range(STEPS)):
            goes_on = 1 - ended[t].astype(np.float32)
            error = lists["reward"][t] + GAMMA * goes_on * after - lists["value"][t]
            advantage[t] = last = error + GAMMA * LAMBDA * goes_on * last
            after = lists["value"][t]
        wanted = torch.from_numpy((advantage + lists["value"]).reshape(-1))
        advantage = torch.from_numpy(((advantage - advantage.mean()) / (advantage.std() + 1e-8)).reshape(-1))
        x, a = torch.from_numpy(seen.reshape(-1, features.size)), torch.from_numpy(acted.reshape(-1, 2))
        log = torch.from_numpy(lists["log"].reshape(-1))
        for group in optimiser.param_groups:
            group["lr"] = rate * (1 - 0.95 * share)
        gains = 0 if before and updates < 12 else 1  # the critic is new, and learns first
        for _ in range(EPOCHS):
            for part in torch.randperm(len(x)).chunk(PARTS):
                drawn = agent.draws(x[part])
                ratio = (drawn.log_prob(a[part]).sum(1) - log[part]).exp()
                gain = torch.min(ratio * advantage[part], ratio.clamp(1 - CLIP, 1 + CLIP) * advantage[part]).mean()
                miss = (agent.critic(x[part])[:, 0] - wanted[part]).square().mean()
                loss = 0.5 * miss - gains * (gain + 0.002 * (1 - share) * drawn.entropy().sum(1).mean())
                optimiser.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
                optimiser.step()
        with torch.no_grad():
            # The noise in actions ends as small as that of a second training: collisions by noise teach fear.
            agent.log_std.clamp_(-2.5, min(0.0, 0.75 - 2.5 * share))
        updates, steps = updates + 1, steps + STEPS * WORLDS
        done = np.array(results, float).reshape(-1, 3)
        success, collision, length = done.mean(0) if len(done) else (0, 0, 0)
        passed = (time.time() - begin) / 60
        curve.write(f"{passed:.2f},{(spent() + env_time(env)) / 60:.2f},{steps},{len(done)},{success:.3f},{collision:.3f},{length:.0f}\n")
        curve.flush()
        if updates % 10 == 0:
            print(f"{passed:5.2f} min {steps / 1e6:5.1f} M steps  success {success:.3f}  collisions {collision:.3f}", flush=True)
            agent.save(file)
    agent.save(file)
    env.close()


def env_time(env):
    """Seconds of processor time of a running simrun."""
    with open(f"/proc/{env.pid}/stat", encoding="ascii") as stat:
        fields = stat.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / 100


def test(file, episodes, people, seed):
    """Each world counts with its first episode alone, so that long ones count as much as short ones."""
    task = {**TASK, "people": people}
    with tempfile.TemporaryDirectory() as folder:
        env = ispace.VectorEnv(write(folder, 10_001, 40), episodes, task=task, copy=False)
    policy = Policy(file, episodes)
    success, collision = np.zeros(episodes, bool), np.zeros(episodes, bool)
    running = np.ones(episodes, bool)
    observations, _ = env.reset(seed=seed)
    while running.any():
        observations, _, over, cut, infos = env.step(policy(observations))
        ends = (over | cut) & running
        if ends.any():
            success |= ends & infos["success"]
            collision |= ends & infos["collision"]
            running &= ~ends
    env.close()
    print(f"{episodes} episodes in 40 unseen rooms, {people} people: "
          f"success {success.mean():.3f}, collisions {collision.mean():.3f}, too late {1 - success.mean() - collision.mean():.3f}")
    return success.mean()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", choices=["train", "test"])
    parser.add_argument("file")
    for name, usual in (("minutes", 10.0), ("rooms", 64), ("episodes", 500), ("people", 10), ("seed", 1)):
        parser.add_argument(f"--{name}", type=type(usual), default=usual)
    parser.add_argument("--before", help="go on from this policy")
    options = parser.parse_args()
    if options.work == "train":
        train(options.file, options.minutes, options.rooms, options.seed, options.before)
    else:
        test(options.file, options.episodes, options.people, options.seed + 1_000_000)
