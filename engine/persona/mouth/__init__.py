"""What is seen between the lips of a person: upper teeth of one photograph, lower ones, tongue and the dark modelled."""
