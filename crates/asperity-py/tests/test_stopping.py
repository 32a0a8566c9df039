"""A run that stops keeps its rows: interrupted, stopped by the caller, failed, or looked at under way; in memory and on disk."""

import signal
import sys
import warnings

import numpy as np
import pytest

import asperity as asp

ZENER = dict(shear=25e6, shear_kelvin=25e6, retardation_time=1.0, poisson=0.5)


@pytest.fixture(scope="module")
def given():
    surface = asp.Surface.sphere(cells=(32, 32), size=(2e-3, 2e-3), radius=10e-3)
    return dict(surface=surface, material=asp.Zener(**ZENER), load=1.0, times=asp.uniform(10.0, 10), fields=["pressure", "gap"], progress=False)


@pytest.fixture(scope="module")
def whole(given):
    return asp.solve(**given)


def same_rows(part, whole, rows):
    assert len(part) == rows
    for name in asp._columns.ROW:
        assert np.array_equal(getattr(part, name), getattr(whole, name)[:rows], equal_nan=True), name
    assert np.array_equal(part.field("gap"), whole.field("gap", index=rows - 1)) and len(part.field_times) == rows


def test_an_interrupted_run_raises_with_its_rows(given, whole, tmp_path):
    def press(step):
        if step.index == 3:
            signal.raise_signal(signal.SIGINT)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt) as caught:
            asp.solve(**given, on_step=press)
        with pytest.raises(KeyboardInterrupt) as stored:
            asp.solve(**given, on_step=press, output=tmp_path / "a.zarr")
    finally:
        signal.signal(signal.SIGINT, before)
    for result in (caught.value.result, stored.value.result, asp.open(tmp_path / "a.zarr")):
        same_rows(result, whole, 4)
        assert result.attributes["status"] == "interrupted"
    caught.value.result.save(tmp_path / "b.zarr")
    assert asp.open(tmp_path / "b.zarr").attributes["status"] == "interrupted"


def test_on_step_stops_a_run(given, whole):
    for answer in (True, np.bool_(True)):
        result = asp.solve(**given, on_step=lambda step: answer if step.index == 2 else None)
        same_rows(result, whole, 3)
        assert result.attributes["status"] == "interrupted"
    # Only True stops: a function may return what it likes. And after the last row nothing is left to stop.
    assert len(asp.solve(**given, on_step=lambda step: step.index)) == 11
    assert asp.solve(**given, on_step=lambda step: step.index == 10).attributes["status"] == "complete"


def test_an_error_carries_the_rows_before_it(given, whole):
    def fail(step):
        if step.index == 1:
            raise RuntimeError("the disk of the caller is full")

    with pytest.raises(RuntimeError, match="full") as caught:
        asp.solve(**given, on_step=fail)
    same_rows(caught.value.result, whole, 2)
    assert caught.value.result.attributes["status"] == "failed"
    with pytest.raises(asp.ConvergenceError) as caught:
        asp.solve(**{**given, "max_iterations": 2})
    assert len(caught.value.result) == 0 and "no rows" in repr(caught.value.result)


def test_a_march_tells_its_rows_so_far(given, whole):
    keys = {key: value for key, value in given.items() if key != "progress"}
    run = asp.march(**keys)
    assert len(run.result()) == 0
    for step in run:
        if step.index == 4:
            same_rows(run.result(), whole, 5)
            assert run.result().attributes["status"] == "interrupted"
    same_rows(run.result(), whole, 11)
    assert run.result().attributes["status"] == "complete"
    assert asp.march(**{**keys, "fields": []}).result().fields == []
    with pytest.raises(ValueError, match="read-only"):
        run.initial_gap[0, 0] = 1.0


def test_output_is_written_as_it_goes(given, whole, tmp_path):
    seen = []
    path = tmp_path / "a.zarr"
    result = asp.solve(**given, output=path, on_step=lambda step: seen.append(len(asp.open(path))), quantities=["elastic_energy", "spot_histogram"])
    # The row of the step is on disk when it is told.
    assert seen == list(range(1, 12)) and result.path == str(path)
    same_rows(result, whole, 11)
    assert result.attributes["status"] == "complete" and result.quantities == ["elastic_energy", "spot_histogram"]
    with pytest.raises(OSError, match="force=True"):
        asp.solve(**given, output=path)
    asp.solve(**given, output=path, force=True)
    adaptive = {**given, "times": asp.adaptive(10.0, first=1e-2), "every": 7}
    memory, disk = asp.solve(**adaptive), asp.solve(**adaptive, output=tmp_path / "b.zarr")
    assert np.array_equal(disk.field_times, memory.field_times) and np.array_equal(disk._stack("gap"), memory._stack("gap"))


def test_nothing_that_is_given_out_changes_a_result(given, tmp_path):
    result = asp.solve(**given, quantities=["elastic_energy", "pressure_histogram"], largest_pressure=1e8)
    data = result.to_xarray()
    histogram = result.histogram("pressure_histogram")
    for array in (result.approach, result.elastic_energy, result.field("gap"), result.initial_gap, result.field_times, result.x, *histogram):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 7.0
    data["approach"][:] = 7.0
    data["pressure"][:] = 7.0
    assert result.approach.max() < 1 and result.field("pressure").max() > 7 and result.field_times[0] == 0
    with pytest.raises(AttributeError, match="cannot be set"):
        result.approach = np.zeros(3)
    result.save(tmp_path / "a.zarr")
    stored = asp.open(tmp_path / "a.zarr")
    mine = stored.field("gap")
    mine[...] = 7.0
    assert np.array_equal(stored.field("gap"), result.field("gap"))
    heights = np.array(given["surface"].heights)
    surface = asp.Surface(heights, size=(2e-3, 2e-3))
    heights[...] = 7.0
    assert np.array_equal(surface.heights, given["surface"].heights)
    with pytest.raises(ValueError, match="read-only"):
        surface.heights[...] = 7.0


def test_attributes_are_those_that_are_there(given, whole):
    assert "contact_fraction" in dir(whole) and "rms_gap" not in dir(whole) and "max_mises" not in dir(whole)
    with pytest.raises(AttributeError, match="contact_area"):
        whole.contact_aera
    step = next(asp.march(**{key: value for key, value in given.items() if key != "progress"}))
    assert "contact_fraction" in dir(step) and "rms_gap" not in dir(step) and isinstance(step.contact_fraction, float)
    with pytest.raises(AttributeError, match="cannot be set"):
        step.load = 1.0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        frame = pytest.importorskip("pandas") and whole.to_dataframe()
    assert frame.index.name == "time" and frame.attrs["units"]["contact_area"] == "m^2" and len(frame) == 11


def test_a_run_that_stops_keeps_the_fields_of_its_last_row(given, whole, tmp_path):
    for row in (0, 3, 4):
        results = []
        for place in (None, tmp_path / f"{row}.zarr"):
            results.append(asp.solve(**given, every=3, output=place, on_step=lambda step: step.index == row))
        held, stored = results
        assert np.array_equal(held.field_times, stored.field_times) and held.field_times[-1] == held.time[-1] == whole.time[row]
        for result in results:
            assert len(result) == row + 1 and np.array_equal(result.field("pressure"), whole.field("pressure", index=row))
    # A run that ends, and one that fails, are stored with the same rows.
    assert len(asp.solve(**given, every=4, output=tmp_path / "end.zarr").field_times) == len(asp.solve(**given, every=4).field_times)


def test_a_path_that_is_taken_says_what_can_be_done(given, tmp_path):
    result = asp.solve(**given, output=tmp_path / "a.zarr")
    for again in (lambda: asp.solve(**given, output=tmp_path / "a.zarr"), lambda: result.save(tmp_path / "a.zarr")):
        with pytest.raises(OSError, match="force=True") as told:
            again()
        assert "resume" not in str(told.value)
    result.save(tmp_path / "a.zarr", force=True)


def test_marches_and_stages_are_told_shortly(given):
    run = asp.march(**{key: value for key, value in given.items() if key != "progress"})
    next(run)
    assert repr(run) == "<March: 1 rows of 11 solved, 32 x 32 cells>"
    assert repr(asp.Stage(approach=asp.hold(), duration=5.0)) == "Stage(approach=hold(), duration=5.0)"


def test_ctrl_c_at_any_line_keeps_the_rows_in_their_places(given, whole, tmp_path):
    """Python raises KeyboardInterrupt between any two lines: here after each line that takes in the rows 3 and 4."""
    code = (asp._record.Record.see.__code__, asp._record.Record._write.__code__)

    def interrupted(line, **rest):
        lines = iter(range(10_000))

        def trace(frame, event, argument):
            if frame.f_code not in code:
                return trace
            if event == "line" and len(frame.f_locals["self"]) in (3, 4) and next(lines) == line:
                raise KeyboardInterrupt
            return trace

        sys.settrace(trace)
        try:
            return asp.solve(**given, **rest)
        except KeyboardInterrupt as error:
            return error.result
        finally:
            sys.settrace(None)

    stopped = 0
    for line in range(200):
        rows = []
        for n, rest in enumerate(({}, {"output": tmp_path / f"{line}.zarr"})):
            result = interrupted(line, **rest)
            for name in asp._columns.ROW:
                assert np.array_equal(getattr(result, name), getattr(whole, name)[: len(result)], equal_nan=True), (line, rest, name)
            for index, time in enumerate(result.field_times):
                held = result.field("pressure", index=index)
                assert np.array_equal(held, whole.field("pressure", time=time)), (line, rest, time)
            assert result.field_times[-1] == result.time[-1]
            rows.append(len(result))
        if min(rows) == len(whole):
            break
        stopped += 1
    assert stopped > 10 and max(rows) == len(whole)
