from gripperd.bench.logbook import Logbook, Moment
from gripperd.bench.settings import PlantSettings
from gripperd.model import Chain

MOMENT = Moment(
    time=0.0,
    step=0.01,
    command=100e3,
    pressure=90e3,
    contraction=0.05,
    rate=0.1,
    direction=1.0,
    force=250.0,
    grip=3.0,
    supply=650e3,
)


def test_a_moment_is_a_track_of_one_sample(chain: Chain) -> None:
    settings = PlantSettings(temperature=300.0, ambient_pressure=98e3)
    track = Logbook(chain, settings).track(MOMENT)
    for name in set(Moment._fields) - {"supply"}:
        assert getattr(track, name).tolist() == [getattr(MOMENT, name)]
    # The regulator is fed with 700 kPa, and 650 are left.
    assert track.supply_drop.tolist() == [50e3]
    assert track.temperature.tolist() == [300.0]
    assert track.ambient.tolist() == [98e3]
    assert track.span == (0.0, 500e3)
    assert track.muscle is chain.muscle


def test_it_counts_the_time_since_the_command_moved(chain: Chain) -> None:
    log = Logbook(chain, PlantSettings())
    commands = [0.0, 0.0, 50e3, 50e3, 50e3]
    still = [
        log.track(MOMENT._replace(time=float(t), command=p)).still.item()
        for t, p in enumerate(commands)
    ]
    assert still == [0.0, 1.0, 0.0, 1.0, 2.0]


def test_an_inflation_counts_once_it_is_over(chain: Chain) -> None:
    log = Logbook(chain, PlantSettings())
    kilopascals = [0, 200, 300, 200, 300, 100, 0, 200, 0, 400, 0]
    counts = [
        log.track(MOMENT._replace(pressure=p * 1e3)).cycle.item() for p in kilopascals
    ]
    assert counts == [0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 2]
