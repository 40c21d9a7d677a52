# SPDX-License-Identifier: GPL-3.0-or-later
"""Motes, nodes of wireless sensor networks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict

from .errors import ProtocolError
from .readings import Reading
from .sensors import SensorOf


@dataclass
class MoteReport(Reading):
    """The light on a mote, and the motes that it hears."""

    def _check(self) -> None:
        self.lux = self.fields.number("lux")
        ids, margins = self.fields.list("neighbours"), self.fields.numbers("margins")
        if len(ids) != len(margins):
            raise ProtocolError(f"a reading of {self.sensor} is incomplete")
        #: by id: dB above the weakest signal that is heard
        self.neighbours: Dict[str, float] = dict(zip(ids, margins))


class Mote(SensorOf[MoteReport]):
    """A mote."""

    _reading = MoteReport

    def __enter__(self) -> Mote:
        return self
