"""Bodies and hands: joints of people, of all the people in a picture, and of drawn figures."""
