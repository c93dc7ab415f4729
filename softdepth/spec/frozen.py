"""What every part of a configuration is."""

from pydantic import BaseModel, ConfigDict


class Frozen(BaseModel):
    """A model that is checked when it is made, and never changes."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)
