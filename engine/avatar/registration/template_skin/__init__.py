"""The skin that is fitted: the part of the template that points are of, its regions, rims and contacts."""
