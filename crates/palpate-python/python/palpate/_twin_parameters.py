"""The numbers of a description that the twins of the step need, in SI."""

from __future__ import annotations

from typing import Any

from palpate._palpate import _contact_numbers
from palpate._twin_step import ContactParameters

#: How scenes refuse a bonded body, and what helps: it pulls, and a jaw that is not at the body yet must not be pulled there.
BOND = "separation = false in the description: a bonded body would pull"
UNBOUND = "hint: set separation = true under [contact] of the test description where the jaw only presses, and calibrate again"
#: A joint no further from first touch than this stands there: positions in single precision are good to it.
AT_TOUCH_M = 1e-6


def contact_numbers(model: Any) -> ContactParameters:
    """The parameters of a contact as floats.

    Parameters
    ----------
    model : path, mapping or Material
        As for `palpate.ContactState`: a protocol's tables ``specimen``, ``law`` and ``contact``.

    Raises
    ------
    OptionError
        A description that makes no contact; the message names the key.
    ModelError
        A law other than latency with one rate coefficient, or a body other than a ball, a pad, a strip, a cylinder or a block with the
        force of uniform strain.

    Examples
    --------
    >>> ball = contact_numbers({
    ...     "specimen": {"shape": "ball", "radius": "35 mm", "modulus": "28 kPa"},
    ...     "law": {"name": "latency", "exponent": 5, "rate_coefficient": "2e4 /s"},
    ... })
    >>> ball.radius_m, ball.modulus_pa, ball.layers, ball.share
    (0.035, 28000.0, 8.0, 0.5)
    """
    return ContactParameters(*_contact_numbers(model))
