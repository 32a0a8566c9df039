"""Where everything is installed that the tests need, a skipped test is a failure.

That is the case under `cargo xtask test`, which names its command in ASPERITY_COMMAND, and wherever CI is set.
"""

import os

import pytest

STRICT = "ASPERITY_COMMAND" in os.environ or "CI" in os.environ
#: Programs that `cargo xtask test` does not install, or only where it can: a test that compares with one of them may be skipped.
OTHERS = ("ContactMechanics", "SurfaceTopography", "tamaas", "pint", "cf_xarray", "pandas")

skipped = []


def note(report):
    if report.skipped and STRICT and not hasattr(report, "wasxfail"):
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
        if not any(name in reason for name in OTHERS):
            skipped.append(f"{report.nodeid}: {reason}")


def pytest_collectreport(report):
    note(report)


def pytest_runtest_logreport(report):
    note(report)


def pytest_sessionfinish(session):
    if skipped:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter):
    if skipped:
        terminalreporter.section("skipped, though nothing may be skipped here")
        for line in skipped:
            terminalreporter.write_line(line)
