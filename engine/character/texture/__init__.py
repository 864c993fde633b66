"""The colours: what is seen, what is made where something passes before it, and the back."""
