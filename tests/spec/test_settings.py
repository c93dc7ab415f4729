"""Configurations from files: what is left out has the defaults that the documentation tells."""

from softdepth.spec.config import PRESETS, Config


def test_keys_left_out_of_a_file_are_those_of_paper_without_its_stored_rows(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("")
    found = Config.load(path).model_dump(exclude={"name"})
    paper = Config.preset("paper").model_dump(exclude={"name"})
    assert any(criterion["stored_rows"] for criterion in paper["criteria"])
    for criterion in paper["criteria"]:
        criterion["stored_rows"] = False
    assert found == paper


def test_a_preset_written_to_a_file_comes_back(tmp_path):
    for name in PRESETS:
        config = Config.preset(name)
        config.save(tmp_path / f"{name}.toml")
        again = Config.load(tmp_path / f"{name}.toml")
        assert again.hash == config.hash, name
        assert again.model_dump(exclude={"name"}) == config.model_dump(exclude={"name"}), name
