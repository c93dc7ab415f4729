"""Where configurations come from and go to: presets, TOML, single keys, plain data."""

import hashlib
import json
import tomllib
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import tomli_w
from pydantic import BaseModel, ValidationError

from softdepth.spec.compensation import Compensation
from softdepth.spec.criteria import CRITERIA, UNKNOWN_KIND, AnyCriterion
from softdepth.spec.errors import ConfigError
from softdepth.spec.frozen import Frozen
from softdepth.spec.post import Post
from softdepth.spec.presets import PRESETS


class Settings(Frozen):
    """What can be read, overridden, written and named by a hash; the keys are its subclass's."""

    @classmethod
    def preset(cls, name: str) -> Self:
        """The preset called `name`; raises `ConfigError` for an unknown one."""
        if name not in PRESETS:
            raise ConfigError(f"unknown preset '{name}'", f"use one of {', '.join(PRESETS)}")
        return cls.from_dict({"name": name, **PRESETS[name]})

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read a TOML file; keys left out have the defaults of the class, not those of a preset."""
        return cls.from_dict({"name": path.stem, **cls._read(path)})

    @classmethod
    def keys_in(cls, path: Path) -> set[str]:
        """The keys that a TOML file sets, wherever `load` can read it."""
        return set(cls._read(path))

    @staticmethod
    def _read(path: Path) -> dict[str, Any]:
        try:
            return tomllib.loads(path.read_text())
        except (OSError, UnicodeDecodeError) as error:
            raise ConfigError(f"cannot read configuration '{path}'", "give a readable TOML file") from error
        except tomllib.TOMLDecodeError as error:
            raise ConfigError(f"'{path}' is not TOML: {error}", "mend that line") from error

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Validate plain data; raises `ConfigError` naming key, value and remedy."""
        try:
            return cls.model_validate({**data})
        except ValidationError as error:
            raise _explain(error, cls, data) from error

    def override(self, assignments: Sequence[str]) -> Self:
        """A copy with ``key=value`` assignments applied; nested keys are dotted (`criteria.0.window`)."""
        data = self.model_dump(mode="json")
        for text in assignments:
            key, equals, value = text.partition("=")
            if not equals:
                raise ConfigError(f"override '{text}' has no '='", "write key=value, for example lanes=8")
            try:
                parsed = tomllib.loads(f"v = {value}")["v"]
            except tomllib.TOMLDecodeError:
                parsed = value  # a bare word is a string
            *parents, leaf = key.strip().split(".")
            node: Any = data
            try:
                for part in parents:
                    node = node[int(part)] if isinstance(node, list) else node[part]
                if isinstance(node, list):
                    node[int(leaf)] = parsed
                else:
                    node[leaf] = parsed
            except (KeyError, ValueError, IndexError, TypeError) as error:
                raise ConfigError(
                    f"unknown key '{key}'", f"known keys: {', '.join(type(self).model_fields)}"
                ) from error
        return self.from_dict(data)

    def to_toml(self) -> str:
        """The whole configuration as TOML; `load` reads it back unchanged."""
        return tomli_w.dumps(self.model_dump(mode="json"))

    def save(self, path: Path) -> None:
        """Write `to_toml` to `path`."""
        path.write_text(self.to_toml())

    def shaping(self) -> dict[str, Any]:
        """All that shapes the core, as plain data."""
        return self.model_dump(mode="json", exclude={"name", "max_multipliers"})

    @cached_property
    def hash(self) -> str:
        """Twelve hex digits that name all that shapes the core: equal hashes build equal cores."""
        return hashlib.sha256(json.dumps(self.shaping(), sort_keys=True).encode()).hexdigest()[:12]


def _criterion(data: Any) -> type[AnyCriterion]:
    return CRITERIA[data.get("kind", "sad")]


def _explain(error: ValidationError, model: type[BaseModel], data: Mapping[str, Any]) -> ConfigError:
    """The first validation error as one line with key, value and remedy."""
    first = error.errors(include_url=False)[0]
    place = list(first["loc"])
    key = ".".join(map(str, place))
    if first["type"] == UNKNOWN_KIND:
        return ConfigError(f"{key}.kind is {first['msg']}", f"use one of {CRITERIA.choices()}")
    if first["type"] == "extra_forbidden":
        tables = {"compensation": Compensation, "post": Post}
        table = tables.get(str(place[0]), model)
        if place[0] == "criteria" and len(place) > 1:
            table = _criterion(data["criteria"][place[1]])
        known = table.model_fields if len(place) > 1 else model.model_fields
        return ConfigError(f"unknown key '{key}'", f"known keys: {', '.join(known)}")
    message = first["msg"].removeprefix("Value error, ")
    if key and isinstance(first["input"], dict):  # values of one table that contradict
        problem, _, remedy = message.partition(": ")
        return ConfigError(f"{key}: {problem}", remedy or "change one of the two")
    if key:
        return ConfigError(f"{key} = {first['input']!r} is not valid", message[0].lower() + message[1:])
    problem, _, remedy = message.partition(": ")
    return ConfigError(problem, remedy or "change one of the two")
