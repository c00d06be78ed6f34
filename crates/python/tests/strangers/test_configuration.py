"""A configuration is a mapping that can be pickled, printed and changed into another."""

import copy
import json
import pickle
import subprocess
import sys
from collections.abc import Mapping

import numpy as np
import pytest

import peristalsis
from peristalsis import Configuration, ConfigurationError, Simulation


@pytest.fixture
def configuration() -> Configuration:
    """A tube of two waves."""
    return Configuration("frictionless", width=2.6, waves=2, seed=3)


def test_a_configuration_is_a_mapping(configuration: Configuration) -> None:
    assert configuration["drive.width"] == 2.6 and configuration["tube"]["waves"] == 2
    assert "drive.width" in configuration and "drive" in configuration and "drive.widht" not in configuration
    assert 3 not in configuration
    assert dict(configuration) == dict(configuration.items()) and len(configuration) == len(dict(configuration))
    assert list(configuration) == configuration.keys() and isinstance(configuration, Mapping)
    assert configuration.values() == [configuration[key] for key in configuration]
    assert configuration.get("drive.force_amplitude") is None and configuration.get("no", 1) == 1
    assert configuration.to_dict()["run"]["seed"] == 3 and "resolved" not in configuration.to_dict()


def test_all_values_of_a_configuration_make_it_again(configuration: Configuration) -> None:
    """Every key that it lists can be given."""
    steps = {"form": "steps", "parameter": "width", "at": [0, 10], "values": [2.9, 2.7]}
    for one in (configuration, Configuration("frictional"), configuration.replace(schedule=[steps])):
        preset = "frictional" if "drive.force_amplitude" in one else "frictionless"
        assert Configuration(preset, dict(one)) == one
        assert Configuration(preset, one) == one
        assert Configuration(preset, one.to_dict()) == one


def test_a_missing_key_says_what_may_be_meant(configuration: Configuration) -> None:
    for wrong in ("drive.widht", "width", "tube.width"):
        with pytest.raises(KeyError, match="drive.width"):
            configuration[wrong]


def test_a_configuration_is_pickled_copied_and_hashed(configuration: Configuration) -> None:
    for other in (pickle.loads(pickle.dumps(configuration)), copy.copy(configuration), copy.deepcopy(configuration)):
        assert other == configuration and hash(other) == hash(configuration)
    wider = configuration.replace(width=2.7)
    assert wider != configuration and {configuration: 1, wider: 2}[configuration.replace()] == 1
    assert configuration != "something else"


def test_values_are_replaced(configuration: Configuration) -> None:
    other = configuration.replace({"run.seed": 4}, width=2.5)
    changed = {key for key in configuration if configuration[key] != other[key]}
    assert changed == {"drive.width", "run.seed"} and other["drive.width"] == 2.5
    assert configuration.replace({"drive.amplitude": 0.25})["drive.width"] == 2.5
    assert Simulation(other).width == 2.5
    with pytest.raises(ConfigurationError, match="drive.width"):
        configuration.replace(width=-1)


def test_a_configuration_prints(configuration: Configuration) -> None:
    assert repr(configuration) == (
        "<peristalsis.Configuration: 41 grains in 2 waves, width 2.6, strain_rate 0.05, seed 3>"
    )
    assert str(configuration) == configuration.to_toml()
    assert "drive.width" in configuration._repr_html_()
    doubtful = configuration.replace(time_step=0.3)
    assert "1 warnings" in repr(doubtful) and "run.time_step" in doubtful._repr_html_()


def test_warnings_name_the_key(configuration: Configuration) -> None:
    """The list of `check` in Python."""
    assert configuration.warnings == ()
    (warning,) = configuration.replace(time_step=0.3).warnings
    assert warning.key == "run.time_step" and "too long for a contact" in warning.message
    key, message = warning
    assert str(warning) == f"{key}: {message}"


def test_a_configuration_is_checked_as_the_command_line_does() -> None:
    """Warnings are one thing everywhere: the list of `check`, what its trial saw included."""
    tube = Configuration("frictionless", width=1.4, waves=2, strain_rate=0.2, transition_threshold=1.5)
    steps = {"form": "steps", "parameter": "width", "at": [0, 90], "values": [1.4, 1.5]}
    tube = tube.replace(schedule=[steps])
    line = [sys.executable, "-m", "peristalsis", "check", "--json", "-"]
    answer = json.loads(subprocess.run(line, input=tube.to_toml(), check=True, capture_output=True, text=True).stdout)
    report = tube.check()
    # How far a trial comes depends on the machine, and with it what it saw, but not of what kind that is.
    keys = [warning["key"] for warning in report["warnings"]]
    assert keys == [warning["key"] for warning in answer["warnings"]] and set(report) == set(answer)
    known = [{"key": it.key, "message": it.message} for it in tube.warnings]
    assert report["warnings"][: len(known)] == known == answer["warnings"][: len(known)]
    assert {"tube.rings_per_wave", "observe.transition_threshold", "drive.schedule"} <= {it.key for it in tube.warnings}
    assert "drive.strain_rate" in keys and report["expected_seconds"] > 0


def test_errors_speak_of_keywords_and_not_of_flags() -> None:
    with pytest.raises(ConfigurationError, match="there is no keyword widht; did you mean 'width'"):
        Simulation.preset("frictionless", widht=2.6)
    for make in (lambda: Simulation.preset("frictionless", width=-1), lambda: Configuration("frictionless", {"drive.widht": 1})):
        with pytest.raises(ConfigurationError) as refused:
            make()
        assert "--set" not in str(refused.value) and "drive.wid" in str(refused.value)
    assert peristalsis.KeyedWarning("a", "b").key == "a"


def test_truth_values_of_numpy_are_truth_values() -> None:
    for value in (True, np.bool_(True)):
        assert Configuration("frictional", {"wall.keep.balance": value})["wall"]["keep"]["balance"] is True
