"""The actor: skin, eyes, teeth, hair and shirt."""
