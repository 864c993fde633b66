"""`python -m scripts.option_types`: the options of the engine's models as types for a checker, galatea/options.py."""

from __future__ import annotations

import types
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel

from engine.avatar import AvatarOptions
from engine.character import CharacterOptions
from engine.persona import PersonaOptions
from engine.portrait import PortraitOptions

OUT_FILE = Path(__file__).parent.parent / "galatea" / "options.py"
FILE_HEAD = '''"""The options of the calls, for a type checker. `python -m scripts.option_types` draws them from the engine's models."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypedDict
'''
CALL_OPTIONS: Mapping[str, tuple[type[BaseModel], tuple[str, ...]]] = {
    "PortraitOptions": (PortraitOptions, ()),
    "CharacterOptions": (CharacterOptions, ("motion",)),  # an argument of its own, which may be a file
    "AvatarOptions": (AvatarOptions, ("motion",)),
    "PersonaOptions": (PersonaOptions, ()),
}
"""The models, and which of their options are no options of the call."""


def spelled(annotation: Any) -> str:
    """A type as a caller may give it: any sequence for a tuple of any length, a mapping for what is a model."""
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return spelled(parts[0])
    if origin in (Union, types.UnionType):
        return " | ".join(spelled(part) for part in parts)
    if origin is Literal:
        return f"Literal[{', '.join(map(_quoted, parts))}]"
    if origin is tuple and parts[-1] is Ellipsis:
        return f"Sequence[{spelled(parts[0])}]"
    if origin is tuple:
        return f"tuple[{', '.join(map(spelled, parts))}]"
    if origin is dict:
        return f"Mapping[{', '.join(map(spelled, parts))}]"
    if annotation is type(None):
        return "None"
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return "Mapping[str, Any]"
    assert annotation in (bool, int, float, str), annotation
    return annotation.__name__


def _quoted(value: object) -> str:
    return f'"{value}"'


def written() -> str:
    """The text of the file."""
    parts = [FILE_HEAD]
    for name, (model, apart) in CALL_OPTIONS.items():
        parts.append(f'\n\nclass {name}(TypedDict, total=False):\n    """{(model.__doc__ or "").split(";")[0]}."""\n\n')
        parts += [
            f"    {option}: {spelled(field.annotation)}\n"
            for option, field in model.model_fields.items()
            if option not in apart
        ]
    return "".join(parts)


if __name__ == "__main__":
    OUT_FILE.write_text(written())
