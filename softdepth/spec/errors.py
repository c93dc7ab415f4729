"""Errors that a user can act on: one line, what is wrong, and the remedy."""


class SoftdepthError(Exception):
    """A problem of the user's making or of the machine's; shown as one line, never as a traceback.

    Parameters
    ----------
    problem : what is wrong, naming the offending value.
    remedy : what the user can do about it.
    """

    def __init__(self, problem: str, remedy: str) -> None:
        self.problem = " ".join(problem.split())
        self.remedy = " ".join(remedy.split())
        super().__init__(f"{self.problem}; {self.remedy}")

    def __reduce__(self) -> tuple[type["SoftdepthError"], tuple[str, str]]:
        """How it comes out of another process: by default Python would give its text alone to `__init__`."""
        return type(self), (self.problem, self.remedy)


class ConfigError(SoftdepthError):
    """A configuration that cannot be built: unknown preset or key, or values that contradict."""


class InputError(SoftdepthError):
    """An image, ground truth or dataset that cannot be used."""


class ToolError(SoftdepthError):
    """A tool of the flow (Verilator, g++, yosys) that is missing or failed."""
