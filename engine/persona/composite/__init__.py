"""The person as they are in one photograph, hair and neck and light, acting what a driver does (`photo_film`)."""
