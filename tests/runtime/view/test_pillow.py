import pytest

from mlmg_runtime.errors import MlmgError
from mlmg_runtime.view import pillow


def test_pictures_without_pillow_say_how_to_install_it(monkeypatch):
    monkeypatch.setattr(pillow, "find_spec", lambda name: None)
    with pytest.raises(pillow.PillowMissingError, match=r'pip install "mlmg\[view\]"') as raised:
        pillow.need_pillow()
    assert isinstance(raised.value, MlmgError)


def test_with_pillow_nothing_is_said():
    pillow.need_pillow()
