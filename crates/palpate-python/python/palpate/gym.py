"""Environments for reinforcement learning: grip a soft body between two fingers and hold it, thousands of grips side by side.

The force of a finger relaxes while it stands still, and so a squeeze that holds at first may let the body slip later; more force than
needed costs reward, and too much crushes the body. Each episode may draw its own body from the covariance of a calibration, or from ranges.

>>> import gymnasium, numpy as np, palpate.gym
>>> envs = gymnasium.make_vec("palpate/SoftGrip-v0", num_envs=3, control="position", mass_kg=0.1)
>>> observations, _ = envs.reset(seed=1)
>>> for _ in range(200):  # 4 s at a squeeze of 1, 6 and 9 mm
...     observations, rewards, terminations, truncations, infos = envs.step(np.array([[-0.9], [-0.4], [-0.1]], np.float32))
...     if terminations.any():
...         break
>>> terminations.tolist(), infos["lost"].tolist()
([True, False, False], [True, False, False])

Needs gymnasium 1.1 or later: ``pip install palpate[gym]``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from palpate._grip_task import Bodies, Control, SoftGripTask, refuse_bond, refuse_ranges, slid, task_of
from palpate._palpate import ContactStates, ModelError, OptionError

try:
    import gymnasium
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space
except ImportError as error:
    raise ImportError(f"palpate.gym needs gymnasium 1.1 or later: {error}\nhint: pip install 'palpate[gym]'") from None

__all__ = ["Control", "SoftGripEnv", "SoftGripTask", "SoftGripVectorEnv", "register"]

#: The environment in gymnasium's registry.
ID = "palpate/SoftGrip-v0"
#: Steps of an episode, where nothing else is stated.
EPISODE = 500
#: Slip that costs all of the cost of slip, m/s.
_FAST_M_PER_S = 0.1
#: Draws from a posterior that are tried until one is a body. Its middle is one, and so is about every second draw or more.
_TRIES = 200

_Doubles = NDArray[np.float64]
_Floats = NDArray[np.float32]
_Marks = NDArray[np.bool_]


def spaces() -> tuple[gymnasium.spaces.Box, gymnasium.spaces.Box]:
    """Observations and actions of one environment."""
    high = np.array([1.0, 2.0, 2.0, 1.0], np.float32)
    return gymnasium.spaces.Box(np.zeros(4, np.float32), high), gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)


def _mode(mode: AutoresetMode | str) -> AutoresetMode:
    """A mode by itself, its name or its value."""
    known = {**AutoresetMode.__members__, **{str(one.value): one for one in AutoresetMode}}
    found = mode if isinstance(mode, AutoresetMode) else known.get(mode)
    if found is None:
        raise OptionError(f"autoreset_mode: expected one of {', '.join(AutoresetMode.__members__)}, found {mode!r}")
    return found


class SoftGripVectorEnv(VectorEnv[_Floats, _Floats, NDArray[Any]]):
    """Many soft bodies between two fingers each, stepped together.

    An **action** in [-1, 1] is a share a' = (a + 1)/2 of the most that can be commanded. With ``control="position"`` the jaw goes to
    a' ``travel_m``; with "force" the finger pushes with f = a' ``force_n`` and moves by c dd/dt = f - F(d); with "impedance" a spring pulls it to
    a' ``travel_m``, c dd/dt = k (a' travel - d) - F(d). The jaw is never faster than
    ``speed_m_per_s``. An action of NaN leaves the command as it was. A jaw that would go beyond the body crushes it, and stays where it was.

    Both equations are integrated in the ``substeps`` of a step by a method of order 2 that is stable at any stiffness: the contact relaxes at rest,
    and the jaw moves by the slope dF/dd before and after. With the default of 4 the force of the default task is within 1 % of the equation from the
    first step on; twice as many substeps have a quarter of the error.

    An **observation** is [d/travel_m, F/force_n, load/(2 mu_0 force_n), t/episode] with the displacement d of the jaw, the force F of a finger,
    the load that the fingers carry, the coefficient of friction mu_0 of the task, and the time t; in [0, 1], force and load up to 2.

    The support gives way from ``lift_s`` on; the load then rises to m g within ``lift_takes_s``. The body **slips** with m dv/dt = load - 2 mu F,
    v >= 0, integrated exactly for a pull load - 2 mu F that goes straight within a step.

    The **reward** of a step is 1 - force_cost F/force_n - slip_cost min(v/(0.1 m/s), 1), less ``loss_cost`` in the step that ends the episode.
    The episode **terminates** where slip exceeds ``slip_limit_m`` (``infos["lost"]``) or F ``crush_force_n``, or where the jaw
    would go beyond the body (``infos["crushed"]``), and is truncated after ``max_episode_steps``.

    Parameters
    ----------
    num_envs : int
        How many.
    max_episode_steps : int, optional
        Steps of an episode; without end if None.
    autoreset_mode : gymnasium.vector.AutoresetMode or str
        ``NEXT_STEP``: the step after the end of an episode begins the next, whatever its action; ``SAME_STEP``: the last step of an episode returns the
        first observation of the next, and ``infos["final_obs"]`` its own; ``DISABLED``: ``reset(options={"reset_mask": mask})`` does.
    copy : bool
        Whether observations are arrays of their own; otherwise the next step writes into them.
    settings
        Those of `SoftGripTask`.

    Raises
    ------
    OptionError, ModelError
        Settings out of range, a body that is none, a body that is bonded to its jaws (``separation = false``).

    Examples
    --------
    >>> import numpy as np, palpate.gym
    >>> ranges = {"modulus_pa": (2e4, 4e4), "mass_kg": (0.05, 0.2)}
    >>> envs = palpate.gym.SoftGripVectorEnv(4096, control="force", ranges=ranges)
    >>> observations, _ = envs.reset(seed=3)
    >>> for _ in range(100):  # 4 N are enough for 0.2 kg at a friction of 0.5: 1.96 N
    ...     observations, rewards, terminations, truncations, infos = envs.step(np.full((4096, 1), -0.2, np.float32))
    >>> bool(terminations.any()), round(float(observations[:, 1].min()), 2)
    (False, 0.4)
    """

    def __init__(
        self,
        num_envs: int = 1,
        *,
        max_episode_steps: int | None = EPISODE,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        **settings: Any,
    ) -> None:
        self.task = task_of(settings)
        refuse_bond(self.task)
        refuse_ranges(self.task)
        if max_episode_steps is not None:
            max_episode_steps = _steps("max_episode_steps", max_episode_steps)
        self.num_envs = _steps("num_envs", num_envs)
        self.autoreset_mode = _mode(autoreset_mode)
        self.metadata = {"render_modes": [], "autoreset_mode": self.autoreset_mode}
        self.single_observation_space, self.single_action_space = spaces()
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.copy, self._episode = copy, max_episode_steps
        #: Steps that the last observation counts as 1.
        self._span = max_episode_steps or EPISODE
        self.bodies = Bodies(self.task, self.num_envs)
        self.contacts = ContactStates(self.task.model, self.num_envs)
        zeros = [np.zeros(self.num_envs) for _ in range(8)]
        self._command, self._jaw, self._next, self._force, self._load, self._pull, self._speed, self._slip = zeros
        self._stiff, self._failed = np.zeros(self.num_envs), np.zeros(self.num_envs, np.bool_)
        self._steps = np.zeros(self.num_envs, np.int64)
        self._observed = np.zeros((self.num_envs, 4), np.float32)
        self._ended = np.zeros(self.num_envs, np.bool_)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[_Floats, dict[str, Any]]:
        """Begins new episodes: of all environments, or of those that ``options["reset_mask"]`` marks."""
        super().reset(seed=seed)
        mask = np.ones(self.num_envs, np.bool_)
        if options is not None and options.get("reset_mask") is not None:
            mask = np.asarray(options["reset_mask"])
            if mask.shape != (self.num_envs,) or mask.dtype != np.bool_:
                raise OptionError(f"reset_mask: expected {self.num_envs} truth values, found {mask.dtype} of shape {mask.shape}")
        self._begin(mask)
        self._observe()
        return self._shown(), {}

    def step(self, actions: ArrayLike) -> tuple[_Floats, _Doubles, _Marks, _Marks, dict[str, Any]]:
        """Takes a step of every environment; see the class for actions, observations, rewards and ends."""
        task, fresh = self.task, None
        # Refused actions leave everything as it was.
        self._take(actions)
        if self.autoreset_mode is AutoresetMode.NEXT_STEP and self._ended.any():
            fresh = self._ended.copy()
            self._begin(fresh)
        self._move(fresh)
        np.add(self._steps, 1, out=self._steps)
        self._bear()
        rewards = 1.0 - task.force_cost / task.force_n * self._force
        rewards -= task.slip_cost / _FAST_M_PER_S * np.minimum(self._speed, _FAST_M_PER_S)
        lost, crushed = self._slip > task.slip_limit_m, (self._force > task.crush_force_n) | self._failed
        terminations = lost | crushed
        truncations = np.zeros(self.num_envs, np.bool_) if self._episode is None else self._steps >= self._episode
        rewards -= task.loss_cost * terminations
        if fresh is not None:
            # Only their first observation counts.
            self._begin_again(fresh)
            rewards[fresh] = 0.0
            for marks in (lost, crushed, terminations, truncations):
                marks[fresh] = False
        np.logical_or(terminations, truncations, out=self._ended)
        self._observe()
        infos: dict[str, Any] = {"lost": lost, "crushed": crushed, "force_n": self._force.copy(), "slip_m": self._slip.copy()}
        if self.autoreset_mode is AutoresetMode.SAME_STEP and self._ended.any():
            infos |= {"final_obs": self._observed.copy(), "_final_obs": self._ended.copy()}
            self._begin(self._ended)
            self._observe()
        return self._shown(), rewards, terminations, truncations, infos

    def _begin(self, mask: _Marks) -> None:
        """New bodies, untouched, in the environments that the mask marks."""
        self.bodies.draw(self.np_random, mask)
        self._take_bodies(np.flatnonzero(mask), mask, _TRIES)
        self._begin_again(mask)

    def _take_bodies(self, places: NDArray[np.intp], mask: _Marks, tries: int) -> None:
        """Contacts with the bodies that were drawn; draws from a posterior that are no body, such as layers thicker than it, are repeated."""
        try:
            self.contacts.reset(mask, **self.bodies.of_body)
        except ModelError:
            if len(places) == 1:
                if tries == 0:
                    raise
                self.bodies.draw_posterior(self.np_random, mask)
                self._take_bodies(places, mask, tries - 1)
                return
            for some in np.array_split(places, 2):
                marked = np.zeros(self.num_envs, np.bool_)
                marked[some] = True
                self._take_bodies(some, marked, tries)

    def _begin_again(self, mask: _Marks) -> None:
        """All back to the start, where the bodies are untouched."""
        for column in (self._command, self._jaw, self._force, self._load, self._pull, self._speed, self._slip, self._steps):
            column[mask] = 0
        self._ended[mask] = False

    def _take(self, actions: ArrayLike) -> None:
        """Actions as commands: a displacement (m) or a force (N); NaN leaves the command as it is."""
        found = np.asarray(actions)
        if found.shape != (self.num_envs, 1):
            raise OptionError(f"actions: expected an array of shape {(self.num_envs, 1)}, found {found.shape}")
        most = self.task.force_n if self.task.control == "force" else self.task.travel_m
        wanted = found[:, 0].astype(np.float64)
        np.clip(wanted, -1.0, 1.0, out=wanted)
        wanted += 1.0
        wanted *= 0.5 * most
        np.copyto(self._command, wanted, where=wanted == wanted)

    def _move(self, fresh: _Marks | None) -> None:
        """Fingers and contacts over a period; those whose episode has just begun stay where they are."""
        task = self.task
        self._failed[:] = False
        if task.control == "position":
            np.copyto(self._next, self._command)
            self._go(task.period_s, task.period_s, task.substeps, fresh)
            return
        # Strang's splitting: the motion of the jaw, half before and half after the relaxation of a part; halves that meet are one.
        part = task.period_s / task.substeps
        self._push(0.5 * part, fresh)
        for left in reversed(range(task.substeps)):
            self.contacts.step(part, self._jaw, out=self._force, errors="mask")
            self._push(part if left else 0.5 * part, fresh)

    def _push(self, dt: float, fresh: _Marks | None) -> None:
        """Motion of the jaws within a time by c dd/dt = f - F(d), while the contacts do not relax.

        With z = (k + dF/dd) dt/c the way is (f - F) dt/c (1 + z/2)/(1 + z + z^2/2): of order 2, and all the way to f = F where z is large.
        """
        task, going, stiff = self.task, self._next, self._stiff
        np.copyto(stiff, self.contacts.stiffness_n_per_m)
        if task.control == "impedance":
            stiff += task.stiffness_n_per_m
            np.subtract(self._command, self._jaw, out=going)
            going *= task.stiffness_n_per_m
            going -= self._force
        else:
            np.subtract(self._command, self._force, out=going)
        stiff *= 0.5 * dt / task.damping_n_s_per_m
        going *= dt / task.damping_n_s_per_m
        # With y = z/2 the factor is 1/(1 + y + y^2/(1 + y)), which stays finite for any y.
        grown = stiff + 1.0
        stiff *= stiff / grown
        stiff += grown
        going /= stiff
        going += self._jaw
        self._go(0.0, dt, 1, fresh)

    def _go(self, relaxes_s: float, dt: float, substeps: int, fresh: _Marks | None) -> None:
        """Jaws towards `_next` as far as their speed lets them within a time, and the forces there."""
        going, reach = self._next, self.task.speed_m_per_s * dt
        np.clip(going, self._jaw - reach, self._jaw + reach, out=going)
        np.clip(going, 0.0, self.task.travel_m, out=going)
        if fresh is not None:
            going[fresh] = 0.0
        self.contacts.step(relaxes_s, going, out=self._force, substeps=substeps, errors="mask")
        failed = self.contacts.failed
        self._failed |= failed
        # A jaw that would go beyond its body stays where it was.
        np.copyto(self._jaw, going, where=~failed)

    def _bear(self) -> None:
        """Load and slip at the end of a period."""
        task, bodies, dt = self.task, self.bodies, self.task.period_s
        lifted = (self._steps * dt - task.lift_s) / task.lift_takes_s
        np.clip(lifted, 0.0, 1.0, out=lifted)
        np.multiply(lifted, bodies.mass_kg * task.gravity_m_per_s2, out=self._load)
        pull = (self._load - 2.0 * bodies.friction * self._force) / bodies.mass_kg
        self._speed, way = slid(self._speed, self._pull, pull, dt)
        self._pull = pull
        self._slip += way

    def _observe(self) -> None:
        task, observed = self.task, self._observed
        np.multiply(self._jaw, 1.0 / task.travel_m, out=observed[:, 0], casting="same_kind")
        np.multiply(self._force, 1.0 / task.force_n, out=observed[:, 1], casting="same_kind")
        np.multiply(self._load, 0.5 / (task.friction * task.force_n), out=observed[:, 2], casting="same_kind")
        np.multiply(self._steps, 1.0 / self._span, out=observed[:, 3], casting="same_kind")
        np.clip(observed, 0.0, self.single_observation_space.high, out=observed)  # type: ignore[attr-defined]

    def _shown(self) -> _Floats:
        return self._observed.copy() if self.copy else self._observed


def _steps(name: str, number: Any) -> int:
    """A whole number above 0."""
    if isinstance(number, bool) or not isinstance(number, (int, np.integer)) or number < 1:
        raise OptionError(f"{name}: expected a whole number, 1 or more, found {number!r}")
    return int(number)


class SoftGripEnv(gymnasium.Env[_Floats, _Floats]):
    """One of the environments of `SoftGripVectorEnv`, with the same actions, observations, rewards and settings.

    `gymnasium.make` keeps a ``max_episode_steps`` to itself: the observed time then is a share of ``span_steps``, 500 if left out.

    Examples
    --------
    >>> import gymnasium, numpy as np, palpate.gym
    >>> env = gymnasium.make("palpate/SoftGrip-v0", control="impedance")
    >>> observation, info = env.reset(seed=0)
    >>> for _ in range(40):
    ...     observation, reward, terminated, truncated, info = env.step(np.array([0.0], np.float32))
    >>> round(info["force_n"], 1), terminated
    (3.4, False)
    """

    metadata = {"render_modes": []}

    def __init__(
        self,
        *,
        max_episode_steps: int | None = None,
        span_steps: int | None = None,
        render_mode: None = None,
        **settings: Any,
    ) -> None:
        self.render_mode = render_mode
        self._envs = SoftGripVectorEnv(
            1, max_episode_steps=max_episode_steps, autoreset_mode=AutoresetMode.DISABLED, **settings
        )
        if span_steps is not None:
            self._envs._span = _steps("span_steps", span_steps)
        self.observation_space, self.action_space = self._envs.single_observation_space, self._envs.single_action_space

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[_Floats, dict[str, Any]]:
        """Begins a new episode."""
        super().reset(seed=seed)
        self._envs.np_random = self.np_random
        observations, _ = self._envs.reset()
        return observations[0], {}

    def step(self, action: _Floats) -> tuple[_Floats, float, bool, bool, dict[str, Any]]:
        """Takes a step; see `SoftGripVectorEnv`."""
        observations, rewards, terminations, truncations, infos = self._envs.step(np.reshape(action, (1, 1)))
        info = {name: values[0].item() for name, values in infos.items()}
        return observations[0], float(rewards[0]), bool(terminations[0]), bool(truncations[0]), info


def register() -> None:
    """Makes ``gymnasium.make("palpate/SoftGrip-v0")`` and ``make_vec`` find the environments; importing this module does."""
    if ID not in gymnasium.registry:
        gymnasium.register(
            id=ID,
            entry_point="palpate.gym:SoftGripEnv",
            vector_entry_point="palpate.gym:SoftGripVectorEnv",
            max_episode_steps=EPISODE,
        )


register()
