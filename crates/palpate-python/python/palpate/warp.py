"""The step of a contact in Warp: `ContactState.step` for kernels, and for the worlds of MuJoCo Warp and Newton.

>>> import numpy as np, palpate.warp, warp as wp
>>> model = {
...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
... }
>>> contacts = palpate.warp.Contacts(model, 3, device="cpu")
>>> for k in range(100):
...     displacement_m = wp.array((k + 1) * np.array([3e-5, 4e-5, 5e-5]), dtype=wp.float64, device="cpu")
...     force_n = contacts.step(1e-3, displacement_m)
>>> force_n.numpy().round(2)
array([1.94, 2.86, 3.89])

`contact_step`, `contact_force` and `contact_stiffness` are functions for your own kernels, in single or double precision: they take a
struct of `contact_parameters` and numbers of its type.

States are arrays of double precision unless `dtype` says otherwise, in worlds of single precision, too: a long hold at short steps moves
the state by less than single precision can tell. Copy `state` and `last` to save contacts, and back to restore them.
"""

from __future__ import annotations

from palpate._twin_step import ContactParameters
from palpate._warp_contacts import Contacts, contact_parameters
from palpate._warp_kernels import (
    ContactParameters32,
    ContactParameters64,
    contact_accepts,
    contact_force,
    contact_step,
    contact_stiffness,
)
from palpate._warp_worlds import GeomContacts, JointContacts, NewtonContacts

__all__ = [
    "ContactParameters",
    "ContactParameters32",
    "ContactParameters64",
    "Contacts",
    "GeomContacts",
    "JointContacts",
    "NewtonContacts",
    "contact_accepts",
    "contact_force",
    "contact_parameters",
    "contact_step",
    "contact_stiffness",
]
