"""GLB files made smaller by the codecs of EXT_meshopt_compression."""
