"""From two OBJ files to a film strip: python3 film_strip.py a.obj b.obj strip.png"""

import sys

import shapespace

*files, strip = sys.argv[1:]
path, summary = shapespace.interpolate(shapespace.read(*files), progress=True)
print(repr(summary))
path.write(strip)
