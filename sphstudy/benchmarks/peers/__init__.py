"""Other codes on the plate of the thesis, side by side with this one: `sphstudy peers`."""
