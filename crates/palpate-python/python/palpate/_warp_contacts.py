"""Contacts in arrays of Warp, stepped side by side; see `palpate.warp`."""

from __future__ import annotations

from typing import Any

import numpy as np

from palpate._frameworks import framework
from palpate._twin_step import ContactParameters
from palpate._warp_kernels import kernels

wp = framework("warp", "warp-lang", "palpate.warp")


def contact_parameters(model: Any, dtype: Any = wp.float64, device: Any = None) -> Any:
    """The parameters of contacts as an array of structs.

    Parameters
    ----------
    model : path, mapping, Material, ContactParameters, or a list of them
        As for `palpate.ContactState`, of a ball, a pad, a strip, a cylinder or a block with the force of uniform strain and the latency
        law; or parameters, each a number or an array over contacts.
    dtype : warp.float32 or warp.float64
    device
        Of Warp; the default one if left out.

    Returns
    -------
    warp.array of ContactParameters32 or ContactParameters64

    Raises
    ------
    OptionError, ModelError
        A description that makes no contact, or one that has no twin.
    """
    models = list(model) if isinstance(model, (list, tuple)) and not isinstance(model, ContactParameters) else [model]
    rows = []
    for one in models:
        if not isinstance(one, ContactParameters):
            from palpate._twin_parameters import contact_numbers

            one = contact_numbers(one)
        rows.append(np.broadcast_arrays(*(np.atleast_1d(np.asarray(value, dtype=np.float64)) for value in one)))
    kind = kernels(dtype).parameters_type
    values = np.concatenate([np.stack(columns, axis=-1) for columns in rows])
    made: Any = np.zeros(len(values), dtype=kind.numpy_dtype())
    for index, name in enumerate(ContactParameters._fields):
        made[name] = values[:, index]
    return wp.array(made, dtype=kind, device=device)


class Contacts:
    """Contacts that are stepped side by side on one device.

    Parameters
    ----------
    model
        As for `contact_parameters`: one for all contacts, or one each.
    count : int
        How many contacts.
    dtype : warp.float32 or warp.float64
        Of states and forces.
    device
        Of Warp; the default one if left out.

    Attributes
    ----------
    parameters : warp.array of structs, shape (1,) or (count,)
    state : warp.array, shape (count, 3)
        Share of the displacement of the jaw, m, displacement of the node behind the contact layer, m, and excess strain of the layer. The
        first two are the state of a `palpate.ContactState`.
    force_n : warp.array, shape (count,)
        Forces after the last step, N.
    refused : warp.array of int, shape (count,)
        Steps that a contact could not make, such as to a displacement beyond the body: its state stayed as it was, and its force, too.
    last : warp.array, shape (count,)
        Time of the last step, s, in a world of MuJoCo Warp; -1 before the first.
    """

    def __init__(self, model: Any, count: int, *, dtype: Any = wp.float64, device: Any = None) -> None:
        self.parameters = contact_parameters(model, dtype, device)
        if count < 1 or count % len(self.parameters):
            raise ValueError(f"count: expected a multiple of the {len(self.parameters)} models, 1 or more, found {count}")
        self.dtype, self.device = dtype, self.parameters.device
        self.state = wp.zeros((count, 3), dtype=dtype, device=device)
        self.force_n = wp.zeros(count, dtype=dtype, device=device)
        self.refused = wp.zeros(count, dtype=int, device=device)
        self.last = wp.full(count, -1.0, dtype=float, device=device)
        self._kernels = kernels(dtype)

    def __len__(self) -> int:
        return len(self.force_n)

    def step(self, dt_s: float, displacement_m: Any) -> Any:
        """Moves every jaw to its displacement within a time step, as `ContactState.step` does.

        Parameters
        ----------
        dt_s : float
            Length of the step, s; 0 or more.
        displacement_m : warp.array, shape (count,) or (1,)
            Where the jaws stand at its end, m, of the type of the contacts.

        Returns
        -------
        warp.array, shape (count,)
            Forces, N: the array `force_n`.
        """
        inputs = [self.parameters, self.dtype(dt_s), displacement_m, self.state, self.force_n, self.refused]
        wp.launch(self._kernels.step, dim=len(self), inputs=inputs, device=self.device)
        return self.force_n

    def stiffness_n_per_m(self) -> Any:
        """Slopes of the forces in the displacement with the node behind the layer at rest, N/m, as a new warp.array of shape (count,)."""
        slope = wp.empty_like(self.force_n)
        wp.launch(self._kernels.stiffness, dim=len(self), inputs=[self.parameters, self.state, slope], device=self.device)
        return slope

    def reset(self, mask: Any = None) -> None:
        """Puts contacts back to first touch and rest.

        Parameters
        ----------
        mask : warp.array of bool, optional
            Which: one value a contact, or one a world for all contacts of that world; all if left out.
        """
        if mask is None:
            mask = wp.full(1, True, dtype=bool, device=self.device)
        if len(self) % len(mask):
            raise ValueError(f"mask: expected one value for each of {len(self)} contacts, or one a world, found {len(mask)}")
        wp.launch(self._kernels.reset, dim=len(self), inputs=[mask, self.state, self.last], device=self.device)
