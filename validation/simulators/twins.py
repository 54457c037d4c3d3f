"""The twins of the step, `palpate.jax`, `palpate.warp` and `palpate.drake`, against `palpate.ContactState`; prints Markdown.

    pip install palpate jax warp-lang mujoco-warp newton drake
    python validation/simulators/twins.py

1. Random motions of every body under every law, bonded and not: largest differences, in double and single precision.
2. Gradients of `palpate.jax` against central differences.
3. MuJoCo Warp, 1,024 worlds on the CPU: forces at joints and between geoms, time of a step with and without contacts.
4. Newton: a finger that a contact stops.
5. Drake: a gripper on a ball, by generalised forces and by forces on bodies.
6. The examples of the modules and of docs/guides/simulators-twins.md.

Every figure has a limit; the script ends with 1 where one is missed.
"""

import doctest
import importlib
import importlib.metadata
import os
import platform
import re
import statistics
import sys
import time
import warnings

os.environ.setdefault("JAX_PLATFORMS", "cpu")

import _programs
import gpu
import numpy as np
import palpate

MODEL = {
    "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
}
#: A block that pulls the jaw back.
BONDED = {
    "specimen": {"shape": "block", "area": "10 cm^2", "length": "50 mm", "modulus": "30 kPa"},
    "law": {"name": "latency", "exponent": 3, "rate_coefficient": "200 /s"},
    "contact": {"separation": False, "squeezed_from": "one side"},
}
#: What is missed, by a sentence.
missed = []


def within(value, limit, what):
    """The value; a sentence where it is beyond its limit."""
    if not value <= limit:
        missed.append(f"{what}: {value:.3g}, at most {limit:g} expected")
    return value


def refuses(make, words, what):
    """Notes a scene that is not refused in these words."""
    try:
        make()
    except (ValueError, palpate.OptionError) as error:
        within(float(words not in str(error)), 0, f"{what}: other words than {words!r}")
    else:
        missed.append(f"{what}: no error")


def programs():
    """Largest differences over motions, by twin, precision and body."""
    import jax
    import jax.numpy as jnp
    import warp as wp

    stored = _programs.reference(steps=400)
    left, met = _programs.crossings(stored)
    assert min(left, met) > 100, (left, met)
    cpu = jax.devices("cpu")[0]
    runs = {
        "NumPy": (1e-12, numpy_runs(stored)),
        "JAX, double": (1e-12, gpu.jax_runs(stored, jnp.float64, cpu)),
        "Warp, double": (1e-12, gpu.warp_runs(stored, wp.float64, "cpu")),
        "JAX, single": (1e-6, gpu.jax_runs(stored, jnp.float32, cpu)),
        "Warp, single": (1e-6, gpu.warp_runs(stored, wp.float32, "cpu")),
    }
    found = {name: _programs.differences(stored, *run) for name, (_, run) in runs.items()}
    for name, (limit, _) in runs.items():
        within(max(max(pair) for pair in found[name].values()), limit, f"{name}, motions")
    lines = [
        f"Motions of {stored['force_n'].shape[0]} steps from 0.1 ms to 0.3 s, {stored['force_n'].shape[1]} contacts, "
        f"n = 5, 3, 1, 1.75 and 0.625; a jaw left its body {left} times and met it {met} times. Largest difference from "
        "`ContactState` over whole motions, the larger of that of the node behind the layer over the depth and that of the force over its "
        "peak:",
        "",
        f"| body | {' | '.join(found)} |",
        f"|---|{'---:|' * len(found)}",
    ]
    for body in next(iter(found.values())):
        lines.append(f"| {body} | {' | '.join(f'{max(by_body[body]):.1e}' for by_body in found.values())} |")
    own_kernel()
    return [*lines, "", one_step(stored), "", loads()]


def own_kernel():
    """The step in a kernel of a user."""
    import warp as wp
    from palpate.warp import ContactParameters32, Contacts, contact_step

    @wp.kernel
    def push(parameters: wp.array(dtype=ContactParameters32), to: float, state: wp.array2d(dtype=float), force: wp.array(dtype=float)):
        i = wp.tid()
        jaw, behind, excess, f = contact_step(parameters[i], state[i, 0], state[i, 1], state[i, 2], 1.0e-3, to)
        state[i, 0] = jaw
        state[i, 1] = behind
        state[i, 2] = excess
        force[i] = f

    contacts = Contacts(MODEL, 1, dtype=wp.float32, device="cpu")
    state, force = wp.zeros((1, 3), dtype=float, device="cpu"), wp.zeros(1, dtype=float, device="cpu")
    for step in range(100):
        to = 5e-5 * (step + 1)
        wp.launch(push, dim=1, inputs=[contacts.parameters, to, state, force], device="cpu")
        contacts.step(1e-3, wp.array([to], dtype=wp.float32, device="cpu"))
    within(abs(float(force.numpy()[0] - contacts.force_n.numpy()[0])), 0, "Warp, a kernel of a user")


def loads():
    """Steps by a force, in double precision."""
    import jax
    import jax.numpy as jnp
    import palpate.jax as twin
    from palpate._twin_parameters import contact_numbers

    described = _programs.models()
    parameters = _programs.stacked([contact_numbers(one) for one in described])
    dt, forces = _programs.load_program(parameters, 200, 5)
    expected, refused = _programs.of_rust_loads(described, dt, forces)
    exact, step = twin.contact_parameters(parameters, jnp.float64), jax.jit(twin.contact_step_force)
    state, worst = twin.contact_state(exact), 0.0
    for index, (length, to) in enumerate(zip(dt, forces)):
        state, _ = step(exact, state, length, to)
        found = np.stack([state.jaw_m, state.behind_m], axis=-1)
        worst = max(worst, float((np.abs(found - expected[index]) / parameters.depth_m[:, None]).max()))
    within(worst, 1e-12, "JAX, steps by a force")
    return f"{forces.size} steps by a force in JAX, {refused} of which no displacement carries: {worst:.1e} of the depth at most."


def numpy_runs(stored):
    from palpate import _twin_step

    parameters = _programs.parameters_of(stored)
    state = _twin_step.state_of(parameters, np.zeros(len(parameters.depth_m)), np.zeros(len(parameters.depth_m)))
    forces, states = np.empty(stored["force_n"].shape), np.empty(stored["state_m"].shape)
    for step, (dt, to) in enumerate(zip(stored["dt_s"], stored["displacement_m"])):
        state, forces[step] = _twin_step.numpy_step(parameters, state, dt, to)
        states[step] = np.stack([state.jaw_m, state.behind_m], axis=-1)
    return forces, states


def one_step(stored):
    """A single step in single precision, from each state of the motions."""
    import jax.numpy as jnp
    import palpate.jax as twin
    import palpate.warp
    import warp as wp

    parameters = _programs.parameters_of(stored)
    before = np.concatenate([np.zeros((1, *stored["state_m"].shape[1:])), stored["state_m"][:-1]])
    jaw, behind = np.moveaxis(before, -1, 0)
    peak = np.abs(stored["force_n"]).max(axis=0)
    single = twin.contact_parameters(parameters, jnp.float32)
    exact = twin.contact_parameters(parameters, jnp.float64)
    start = twin.contact_state(exact, jaw, behind)
    rounded = type(start)(*(jnp.asarray(value, jnp.float32) for value in start))
    dt, to = stored["dt_s"][:, None], stored["displacement_m"]
    state, force = twin.contact_step(single, rounded, dt, to)

    def worst(behind_m, force_n, what):
        node = np.abs(behind_m - stored["state_m"][..., 1]) / parameters.depth_m
        return within(max(node.max(), (np.abs(force_n - stored["force_n"]) / peak).max()), 1e-6, what)

    of_jax = worst(np.asarray(state.behind_m, np.float64), np.asarray(force, np.float64), "JAX, single, one step")
    contacts = palpate.warp.Contacts(parameters, len(peak), dtype=wp.float32, device="cpu")
    nodes, forces = np.empty(jaw.shape), np.empty(jaw.shape)
    for step in range(len(jaw)):
        contacts.state.assign(np.stack([np.asarray(value)[step] for value in rounded], axis=-1))
        contacts.step(float(dt[step, 0]), wp.array(to[step], dtype=wp.float32, device="cpu"))
        nodes[step], forces[step] = contacts.state.numpy()[:, 1], contacts.force_n.numpy()
    of_warp = worst(nodes, forces, "Warp, single, one step")
    return f"One step in single precision from each of these states: JAX {of_jax:.1e}, Warp {of_warp:.1e}."


def gradients():
    """Derivatives of the mean force in the logarithms of the parameters, and in a displacement."""
    import jax
    import jax.numpy as jnp
    import palpate.jax as twin

    names = ("modulus_pa", "depth_m", "layers", "radius_m", "exponent", "rate_coefficient_per_s")
    exact = twin.contact_parameters(MODEL, jnp.float64)
    inside = jnp.concatenate([jnp.linspace(0, 0.01, 40), jnp.full(40, 0.01), jnp.linspace(0.01, 0.006, 10)])
    across = jnp.concatenate([jnp.linspace(0, 0.02, 30), jnp.linspace(0.02, -0.002, 25), jnp.full(5, -0.002), jnp.linspace(0, 0.02, 25)])
    rows = ["| derivative of the mean force | jaw stays on | jaw leaves and meets |", "|---|---:|---:|"]

    @jax.jit
    def mean_force(logarithms, to):
        parameters = exact._replace(**{n: getattr(exact, n) * jnp.exp(x) for n, x in zip(names, logarithms)})
        start = twin.contact_state(parameters)
        return jnp.mean(jax.lax.scan(lambda state, d: twin.contact_step(parameters, state, 0.02, d), start, to)[1])

    at = jnp.zeros(len(names))
    by_motion = []
    for to, step in ((inside, 1e-5), (across, 2e-4)):
        by_gradient = [*jax.grad(mean_force)(at, to), jax.grad(mean_force, argnums=1)(at, to)[20] * 0.01]

        def moved(index, h, to=to):
            if index == len(names):
                return mean_force(at, to.at[20].add(0.01 * h))
            return mean_force(at.at[index].add(h), to)

        by_difference = [float(moved(k, step) - moved(k, -step)) / (2 * step) for k in range(len(names) + 1)]
        scale = float(mean_force(at, to))
        by_motion.append([abs(a - b) / max(abs(b), 1e-3 * scale) for a, b in zip(map(float, by_gradient), by_difference)])
    for name, on, across_it in zip([*names, "a displacement"], *by_motion):
        within(on, 1e-6, f"gradient in {name}, jaw stays on")
        within(across_it, 1e-4, f"gradient in {name}, jaw leaves")
        rows.append(f"| in {name if name == 'a displacement' else 'ln ' + name} | {on:.1e} | {across_it:.1e} |")
    finite_at_rest()
    return ["Relative difference from central differences:", "", *rows]


def finite_at_rest():
    """Derivatives at no excess strain, of every law, and of a step that is denied: none is NaN."""
    import jax
    import jax.numpy as jnp
    import palpate.jax as twin

    for exponent in (0.5, 1.0, 2.0, 5.0):
        for to in (0.0, -1e-3, 1e-3, 0.1, float("nan")):
            exact = twin.contact_parameters(MODEL, jnp.float64)._replace(exponent=jnp.float64(exponent))

            def force(parameters, d):
                return twin.contact_step(parameters, twin.contact_state(parameters), 1e-3, d)[1]

            tree = jax.grad(force, argnums=(0, 1))(exact, jnp.float64(to))
            finite = all(bool(jnp.isfinite(leaf)) for leaf in jax.tree.leaves(tree))
            within(float(not finite), 0, f"gradient at rest, n = {exponent}, displacement {to} m")
    # Below n = 1 a body comes to rest; one that is at rest and pressed has the slope that differences have, in the limit of small ones.
    for exponent in (0.5, 0.8, 1.0, 2.0):
        exact = twin.contact_parameters(MODEL, jnp.float64)._replace(exponent=jnp.float64(exponent))

        def after_rest(d, exact=exact):
            jaw_m = 0.01 * exact.share
            rested = twin.contact_state(exact)._replace(jaw_m=jaw_m, behind_m=jaw_m * (1 - 1 / exact.layers), excess=0.0 * jaw_m)
            return twin.contact_step(exact, rested, 0.01, 0.01 + d)[1]

        by_difference = float(after_rest(1e-9) - after_rest(-1e-9)) / 2e-9
        within(abs(float(jax.grad(after_rest)(0.0)) / by_difference - 1), 1e-3, f"slope after rest, n = {exponent}")


GRIPPER = """
<mujoco>
  <option timestep="0.001" integrator="implicitfast"/>
  <worldbody>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="ball" pos="0 0 0.3"><geom name="ball" type="sphere" size="0.035" contype="0" conaffinity="0"/></body>
    <body pos="-0.06 0 0.3">
      <joint name="left" type="slide" axis="1 0 0" damping="2"/>
      <geom name="left" type="box" size="0.01 0.02 0.02" mass="0.1" contype="0" conaffinity="0"/>
    </body>
    <body pos="0.06 0 0.3">
      <joint name="right" type="slide" axis="-1 0 0" damping="2"/>
      <geom name="right" type="box" size="0.01 0.02 0.02" mass="0.1" contype="0" conaffinity="0"/>
    </body>
    <body pos="0 0.3 0.3">
      <freejoint/><geom type="box" size="0.03 0.03 0.03" mass="0.2"/>
      <body pos="0 0 0.05">
        <joint type="hinge" axis="1 0 0" damping="0.01"/><geom type="capsule" fromto="0 0 0 0 0 0.1" size="0.01" mass="0.05"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="left" joint="left" kp="400"/>
    <position name="right" joint="right" kp="400"/>
  </actuator>
</mujoco>
"""


def worlds(count, by_geoms=False):
    """Worlds of MuJoCo Warp with a gripper around a ball that is fixed, and the contacts, not attached."""
    import mujoco
    import mujoco_warp as mjw
    import palpate.warp

    mj_model = mujoco.MjModel.from_xml_string(GRIPPER)
    mj_data = mujoco.MjData(mj_model)
    mj_data.ctrl[:] = 0.025
    mujoco.mj_forward(mj_model, mj_data)
    m, d = mjw.put_model(mj_model), mjw.put_data(mj_model, mj_data, nworld=count)
    if by_geoms:
        pairs = [(mj_model.geom(name).id, mj_model.geom("ball").id) for name in ("left", "right")]
        contacts = palpate.warp.GeomContacts(m, d, MODEL, pairs, touch_m=0.045)
    else:
        one_side = {**MODEL, "contact": {"squeezed_from": "one side"}}
        joints = [mj_model.joint(name).id for name in ("left", "right")]
        contacts = palpate.warp.JointContacts(m, d, one_side, joints, touch_m=0.015)
    return mjw, m, d, contacts


def mujoco_warp():
    """Forces in worlds of MuJoCo Warp, and the time of a step."""
    rows = []
    for by_geoms in (False, True):
        mjw, m, d, contacts = worlds(2, by_geoms)
        contacts.attach(m)
        one_side = {**MODEL, "contact": {"squeezed_from": "one side"}}
        rust = [palpate.ContactState(one_side) for _ in range(2)]
        worst, peak, of_push = 0.0, 0.0, 0.0
        for step in range(400):
            q, speed = d.qpos.numpy()[0, :2] - np.float32(0.015), d.qvel.numpy()[0, :2].copy()
            mjw.step(m, d)
            if by_geoms:
                at = d.geom_xpos.numpy()[0]
                q = [np.float32(0.045) - np.float32(np.linalg.norm(at[1] - at[k])) for k in (2, 3)]
            forces = [one.step(1e-3 if step else 0.0, float(to)) for one, to in zip(rust, q)]
            peak = max(peak, *forces)
            worst = max(worst, float(np.abs(contacts.force_n.numpy()[:2] - forces).max()))
            # The damping of the joints is passive, too.
            of_push = max(of_push, float(np.abs(d.qfrc_passive.numpy()[0, :2] + 2 * speed + forces).max()))
        title = "between geoms" if by_geoms else "at joints"
        limit = 2e-5 if by_geoms else 1e-6
        within(worst / peak, limit, f"MuJoCo Warp, force {title}")
        within(of_push / peak, 2e-5, f"MuJoCo Warp, force on the fingers {title}")
        rows.append(f"forces {title} {worst / peak:.1e} of their peak of {peak:.2f} N")
    saved_and_reset()
    without, more, alone = step_times()
    within(more, 0.02, "MuJoCo Warp, additional time of a step")
    return [
        f"Largest difference from `ContactState` along 400 steps of 1 ms of a gripper that closes on a ball: {', '.join(rows)}. "
        "Contacts that were restored, or reset with their worlds, repeat their forces to the last bit. "
        f"A step of 1,024 worlds on one core takes {without * 1e3:.1f} ms of processor time without contacts, and "
        f"{100 * more:+.1f} % with two contacts a world (median of 60 pairs); their callback alone takes {alone * 1e3:.2f} ms.",
    ]


def saved_and_reset():
    """Contacts of worlds that are saved, restored and reset."""
    import mujoco
    import mujoco_warp as mjw
    import palpate.warp
    import warp as wp

    _, m, d, contacts = worlds(3)
    contacts.attach(m)

    def forces(steps):
        found = []
        for _ in range(steps):
            mjw.step(m, d)
            found.append(contacts.force_n.numpy().copy())
        return np.array(found)

    first = forces(200)
    arrays = [d.qpos, d.qvel, d.time, d.qacc_warmstart, contacts.state, contacts.last]
    saved = [wp.clone(array) for array in arrays]
    on = forces(100)
    for array, copy in zip(arrays, saved):
        wp.copy(array, copy)
    within(float(np.abs(forces(100) - on).max()), 0, "MuJoCo Warp, forces after contacts were restored")
    mjw.reset_data(m, d)
    d.ctrl.fill_(0.025)
    within(float(np.abs(forces(200) - first).max()), 0, "MuJoCo Warp, forces after worlds were reset")
    contacts.reset(wp.array([True, False, False], dtype=bool, device="cpu"))
    state = np.abs(contacts.state.numpy()).sum(axis=1).reshape(3, 2)
    within(float(state[0].max() != 0 or state[1:].min() == 0), 0, "MuJoCo Warp, reset by a mask of worlds")
    rk4 = mujoco.MjModel.from_xml_string(GRIPPER.replace("implicitfast", "RK4"))
    m, d = mjw.put_model(rk4), mjw.put_data(rk4, mujoco.MjData(rk4))
    refuses(lambda: palpate.warp.JointContacts(m, d, MODEL, [0]), "RK4", "MuJoCo Warp, RK4")
    mj_model = mujoco.MjModel.from_xml_string(GRIPPER)
    m, d = mjw.put_model(mj_model), mjw.put_data(mj_model, mujoco.MjData(mj_model))
    joint, pair = mj_model.joint("left").id, (mj_model.geom("left").id, mj_model.geom("ball").id)
    at_joint = lambda touch_m: palpate.warp.JointContacts(m, d, BONDED, [joint], touch_m=touch_m)
    at_joint(0.0)
    refuses(lambda: at_joint(0.015), "0.015 m before first touch", "MuJoCo Warp, a bonded body across the air")
    at_geoms = lambda: palpate.warp.GeomContacts(m, d, BONDED, [pair], touch_m=0.045)
    refuses(at_geoms, "from any distance", "MuJoCo Warp, a bonded body between geoms")


def step_times():
    """Processor time of a step of 1,024 worlds, s, how much more it is with contacts, and that of their callback, s."""
    import warp as wp

    def timed(function):
        start = time.process_time()
        function()
        wp.synchronize()
        return time.process_time() - start

    both = [worlds(1024) for _ in range(2)]
    both[1][3].attach(both[1][1])
    for _ in range(40):
        for mjw, m, d, _contacts in both:
            mjw.step(m, d)
    pairs = []
    for turn in range(60):
        # Each is first in every other turn.
        order = (0, 1) if turn % 2 else (1, 0)
        times = {which: timed(lambda which=which: both[which][0].step(*both[which][1:3])) for which in order}
        pairs.append((times[0], times[1]))
    _, m, d, contacts = both[1]
    alone = statistics.median(timed(lambda: contacts(m, d)) for _ in range(60))
    return statistics.median(a for a, _ in pairs), statistics.median(b / a for a, b in pairs) - 1, alone


def newton_run():
    """A finger on a rail in Newton that runs into a ball which is fixed."""
    import newton
    import palpate.warp
    import warp as wp

    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    finger = builder.add_link(mass=0.2, inertia=wp.mat33(np.eye(3) * 1e-4), xform=wp.transform((-0.06, 0.0, 0.0), wp.quat_identity()))
    joint = builder.add_joint_prismatic(
        parent=-1, child=finger, parent_xform=wp.transform((-0.06, 0.0, 0.0), wp.quat_identity()), axis=newton.Axis.X
    )
    builder.add_articulation([joint])
    with wp.ScopedDevice("cpu"):
        model = builder.finalize()
        solver = newton.solvers.SolverFeatherstone(model)
        state, after, control = model.state(), model.state(), model.control()
        state.joint_qd.assign(np.array([0.1], dtype=np.float32))
        newton.eval_fk(model, state.joint_q, state.joint_qd, state)
        one_side = {**MODEL, "contact": {"squeezed_from": "one side"}}
        contacts = palpate.warp.NewtonContacts(model, one_side, [(finger, -1)], touch_m=0.035)
        rust, worst, peak, deepest = palpate.ContactState(one_side), 0.0, 0.0, 0.0
        for step in range(2000):
            state.clear_forces()
            contacts.apply(state, 1e-3)
            to = float(np.float32(0.035) - np.float32(abs(state.body_q.numpy()[0, 0])))
            force = rust.step(1e-3 if step else 0.0, to)
            worst, peak = max(worst, abs(float(contacts.force_n.numpy()[0]) - force)), max(peak, force)
            deepest = max(deepest, to)
            solver.step(state, after, control, None, 1e-3)
            state, after = after, state
        leaving = float(state.joint_qd.numpy()[0])
    at_bodies = lambda: palpate.warp.NewtonContacts(model, BONDED, [(finger, -1)], touch_m=0.035)
    refuses(at_bodies, "from any distance", "Newton, a bonded body")
    within(worst / peak, 1e-6, "Newton, force")
    within(leaving, 0.0, "Newton, velocity of the finger after the contact")
    within(-leaving, 0.1, "Newton, speed of the finger after the contact")
    return [
        f"A finger of 0.2 kg at 0.1 m/s runs into a ball: {1e3 * deepest:.2f} mm deep, peak {peak:.2f} N, and back at "
        f"{-leaving:.3f} m/s; largest difference from `ContactState` {worst / peak:.1e} of the peak."
    ]


def drake_run():
    """A gripper of two fingers on a ball in Drake, twice."""
    import palpate.drake
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import PrismaticJoint, SpatialInertia
    from pydrake.systems.analysis import Simulator
    from pydrake.systems.framework import DiagramBuilder

    def gripper(by_bodies, bond=None):
        builder = DiagramBuilder()
        plant = builder.AddSystem(MultibodyPlant(1e-3))
        inertia = SpatialInertia.SolidSphereWithMass(0.1, 0.01)
        ball = plant.AddRigidBody("ball", inertia)
        plant.WeldFrames(plant.world_frame(), ball.body_frame())
        joints, fingers = [], []
        for name, side in (("left", -1.0), ("right", 1.0)):
            finger = plant.AddRigidBody(name, inertia)
            joints.append(
                plant.AddJoint(PrismaticJoint(name, plant.world_frame(), finger.body_frame(), [-side, 0.0, 0.0], damping=0.2))
            )
            joints[-1].set_default_translation(-0.06)
            fingers.append(finger)
        plant.Finalize()
        if by_bodies:
            contacts = builder.AddSystem(
                palpate.drake.BodyContactSystem([(finger, ball) for finger in fingers], bond or MODEL, 1e-3, touch_m=0.035)
            )
            builder.Connect(plant.get_body_poses_output_port(), contacts.GetInputPort("body_poses"))
            builder.Connect(contacts.GetOutputPort("spatial_forces"), plant.get_applied_spatial_force_input_port())
        else:
            one_side = {**MODEL, "contact": {"squeezed_from": "one side"}}
            contacts = builder.AddSystem(palpate.drake.JointContactSystem(plant, joints, bond or one_side, 1e-3, touch_m=-0.035))
            builder.Connect(plant.get_state_output_port(), contacts.GetInputPort("plant_state"))
            builder.Connect(contacts.GetOutputPort("generalized_force"), plant.get_applied_generalized_force_input_port())
        return plant, joints, contacts, builder.Build()

    rows, ends = [], []
    for by_bodies in (False, True):
        plant, joints, contacts, diagram = gripper(by_bodies)
        simulator = Simulator(diagram)
        context = simulator.get_mutable_context()
        of_plant, of_contacts = plant.GetMyMutableContextFromRoot(context), contacts.GetMyContextFromRoot(context)
        for joint in joints:
            joint.set_translation_rate(of_plant, 0.3)
        one_side = {**MODEL, "contact": {"squeezed_from": "one side"}}
        rust, worst, peak = palpate.ContactState(one_side), 0.0, 0.0
        simulator.Initialize()
        for step in range(300):
            if step:
                simulator.AdvanceTo(1e-3 * step)
            to = joints[0].get_translation(of_plant) + 0.035
            force = rust.step(1e-3 if step else 0.0, to)
            forces = contacts.GetOutputPort("force_n").Eval(of_contacts)
            worst, peak = max(worst, abs(forces[0] - force), abs(forces[1] - force)), max(peak, force)
        ends.append(joints[0].get_translation(of_plant))
        title = "on bodies" if by_bodies else "at joints"
        within(worst / peak, 1e-9, f"Drake, forces {title}")
        rows.append(f"forces {title} {worst / peak:.1e} of their peak of {peak:.2f} N")
    within(abs(ends[0] - ends[1]), 1e-9, "Drake, the two grippers")
    warned = refused_by_drake(palpate.drake.ContactSystem)
    refuses(lambda: gripper(True, BONDED), "from any distance", "Drake, a bonded body between bodies")
    across = gripper(False, BONDED)[-1]
    refuses(lambda: Simulator(across).AdvanceTo(1e-3), "0.025 m before first touch", "Drake, a bonded body across the air")
    return [
        f"A gripper whose fingers of 0.1 kg meet a ball at 0.3 m/s, 300 steps of 1 ms; largest difference from `ContactState`: "
        f"{', '.join(rows)}. A displacement beyond the body and one of NaN: {warned}."
    ]


def refused_by_drake(system):
    """What a displacement beyond the body and NaN do."""
    contact = system(MODEL, 1e-3)
    context = contact.CreateDefaultContext()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        for to in (1.0, float("nan")):
            contact.GetInputPort("displacement_m").FixValue(context, [to])
            force = contact.GetOutputPort("force_n").Eval(context)[0]
            within(float(not np.isfinite(force)), 0, "Drake, a force that is no number")
        contact.GetInputPort("displacement_m").FixValue(context, [1e-3])
        context.get_mutable_discrete_state(0).SetFromVector([np.nan, np.nan])
        force = contact.GetOutputPort("force_n").Eval(context)[0]
        within(float(not np.isfinite(force)), 0, "Drake, a force of a state of NaN")
        contact.reset(context)
        force = contact.GetOutputPort("force_n").Eval(context)[0]
        within(float(force != palpate.ContactState(MODEL).step(0.0, 1e-3)), 0, "Drake, a force after a reset")
        context.get_mutable_discrete_state(0).SetFromVector([0.0, 0.0])
        contact.GetInputPort("displacement_m").FixValue(context, [1.0])
        force = contact.GetOutputPort("force_n").Eval(context)[0]
    assert [one.category for one in caught] == [palpate.PalpateWarning], caught
    return f"one warning, force {force:g} N"


def examples():
    """Runs the examples of the modules and of the guide."""
    count = 0
    for name in ("palpate._twin_parameters", "palpate.jax", "palpate.warp", "palpate.drake"):
        result = doctest.testmod(importlib.import_module(name))
        within(result.failed, 0, f"examples of {name}")
        count += result.attempted
    text = (_programs.ROOT / "docs/guides/simulators-twins.md").read_text(encoding="utf-8")
    names = {}
    blocks = re.findall(r"^```python\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)
    for block in blocks:
        exec(block, names)
    return [f"{count} lines of examples in the modules and {len(blocks)} blocks of the guide ran."]


def page():
    """The section as Markdown."""
    import jax
    import warp as wp

    jax.config.update("jax_enable_x64", True)
    wp.config.log_level = wp.LOG_WARNING
    packages = ("jax", "warp-lang", "mujoco-warp", "newton", "drake", "numpy")
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in packages)
    lines = ["## Twins of the step", "", f"{versions}, Python {platform.python_version()}, {platform.machine()}, on the CPU.", ""]
    parts = [
        ("JAX and Warp against `ContactState`", programs),
        ("Gradients of `palpate.jax`", gradients),
        ("MuJoCo Warp", mujoco_warp),
        ("Newton", newton_run),
        ("Drake", drake_run),
        ("Examples", examples),
    ]
    for title, part in parts:
        lines += [f"### {title}", "", *part(), ""]
    if missed:
        lines += ["**Missed:** " + "; ".join(missed) + ".", ""]
    return "\n".join(lines)


if __name__ == "__main__":
    print(page())
    sys.exit(1 if missed else 0)
