"""Predictions: current to force and force to current, for one size or many."""

# ruff: noqa: N815  (names carry units, and units have capitals)

import asyncio
from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from gripperd.config.section import Section
from gripperd.errors import InputError
from gripperd.model import Chain, Direction, Prediction, PressedObject
from gripperd.model.pressed import RIGID
from gripperd.service.body import disagreement, router
from gripperd.service.context import Daemon
from gripperd.service.rendering import GIVEN, MEASURED, Document, to
from gripperd.service.target import Milliamperes, Millimetres, Newtons, check_current
from gripperd.units import MILLI, SI_PER_UNIT

MOST_SIZES = 1000
DIRECTIONS = {
    "contracting": Direction.CONTRACTING,
    "extending": Direction.EXTENDING,
}

routes = router("predictions")


Sizes = Annotated[list[Millimetres], Field(min_length=1, max_length=MOST_SIZES)]


class PredictionRequest(Section):
    """A current or a force, and the size of one object or of many."""

    gripper: str | None = Field(default=None, description="By default the first.")
    current_mA: Milliamperes | None = None
    force_N: Newtons | None = None
    diameter_mm: Annotated[
        Annotated[Millimetres, Tag("size")] | Annotated[Sizes, Tag("sizes")],
        Discriminator(lambda given: "sizes" if isinstance(given, list) else "size"),
    ]
    stiffness_N_per_mm: float | None = Field(
        default=None, gt=0, le=100_000, description="By default the object is rigid."
    )
    direction: Literal["contracting", "extending"] = Field(
        default="contracting", description="How the muscle came to where it is."
    )

    @model_validator(mode="after")
    def _one_target(self) -> Self:
        if (self.current_mA is None) == (self.force_N is None):
            message = "give either current_mA or force_N"
            raise disagreement(message)
        return self


class PredictionDocument(Document):
    """Everything the model says about one size."""

    diameter_mm: float
    current_mA: float
    pressure_kPa: float = Field(description="Gauge, in the muscle.")
    opening_mm: float = Field(description="With the object pressed together.")
    contraction: float
    muscle_force_N: float = Field(description="Signed; below 0 the muscle is slack.")
    spring_force_N: float
    force_N: float = Field(description="Grip force per jaw.")
    std_N: float = Field(description="Its standard deviation, from the tolerances.")
    reaches: bool = Field(description="The jaws press on the object at all.")
    extrapolated: bool = Field(
        description="The muscle works outside what it is specified for."
    )


class Predictions(Document):
    """One prediction for each size, in the order asked for."""

    gripper: str
    model: str
    direction: str
    stiffness_N_per_mm: float | None = Field(description="Null: rigid.")
    predictions: tuple[PredictionDocument, ...]


@routes.post("/predictions")
async def predict(daemon: Daemon, asked: PredictionRequest) -> Predictions:
    """Predict grip forces, or the currents that they take; nothing moves."""
    gripper = await daemon.up_to_date(daemon.chosen_gripper(asked.gripper))
    check_current(asked.current_mA, gripper.chain)
    given = asked.diameter_mm
    found = []
    for index, size in enumerate(given if isinstance(given, list) else [given]):
        place = f"diameter_mm/{index}" if isinstance(given, list) else "diameter_mm"
        prediction = predicted(asked, size, gripper.chain, place)
        found.append(prediction_document(prediction, size))
        # A long list must not keep a stop waiting.
        await asyncio.sleep(0)
    return Predictions(
        gripper=gripper.name,
        model=gripper.chain.name,
        direction=asked.direction,
        stiffness_N_per_mm=asked.stiffness_N_per_mm,
        predictions=tuple(found),
    )


def predicted(
    asked: PredictionRequest, size_mm: float, chain: Chain, place: str
) -> Prediction:
    """Predict for one size.

    Raises
    ------
    InputError
        The size does not fit, or the valve cannot do it; ``place`` is its key.
    """
    stiffness = RIGID
    if asked.stiffness_N_per_mm is not None:
        stiffness = asked.stiffness_N_per_mm * SI_PER_UNIT["N_per_mm"]
    pressed = PressedObject(size_mm * MILLI, stiffness)
    direction = DIRECTIONS[asked.direction]
    try:
        chain.check_fits(pressed.diameter)
        current = asked.current_mA and asked.current_mA * MILLI
        if current is None:
            assert asked.force_N is not None
            current = _current_for(asked.force_N, pressed, direction, chain)
        return chain.predict(current, pressed, direction)
    except InputError as error:
        keys = {"diameter_mm": place, "pressure_kPa": "force_N"}
        key = error.key and keys.get(error.key, error.key)
        raise InputError(str(error), key=key) from error


def _current_for(
    force: float, pressed: PressedObject, direction: Direction, chain: Chain
) -> float:
    if force >= pressed.stiffness * pressed.diameter:
        message = (
            f"{force:g} N would press an object of {pressed.diameter / MILLI:g} mm flat"
        )
        raise InputError(message, key="force_N")
    current = chain.current_for(force, pressed, direction)
    regulator = chain.regulator
    if not regulator.current_low <= current <= regulator.current_high:
        most = chain.predict(regulator.current_high, pressed, direction)
        message = (
            f"{force:g} N on {pressed.diameter / MILLI:g} mm takes"
            f" {current / MILLI:.2f} mA, outside {regulator.current_low / MILLI:g} to"
            f" {regulator.current_high / MILLI:g} mA, the valve's range; the most it"
            f" gives there is {most.grip_force:.1f} N"
        )
        raise InputError(message, key="force_N")
    return current


def prediction_document(prediction: Prediction, size_mm: float) -> PredictionDocument:
    """Describe a prediction for the outside."""
    return PredictionDocument(
        diameter_mm=size_mm,
        current_mA=to("mA", prediction.current, GIVEN),
        pressure_kPa=to("kPa", prediction.pressure),
        opening_mm=to("mm", prediction.opening),
        contraction=float(f"{prediction.contraction:.{MEASURED}g}"),
        muscle_force_N=to("N", prediction.muscle_force),
        spring_force_N=to("N", prediction.spring_force),
        force_N=to("N", prediction.grip_force),
        std_N=to("N", prediction.grip_std),
        reaches=prediction.reaches,
        extrapolated=prediction.extrapolated,
    )
