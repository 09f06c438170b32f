#!/bin/sh
# Makes DejaVuSans-subset.ttf again, from Debian's packages fonts-dejavu-core and python3-fonttools:
# the letters of languages in Latin, Greek and Cyrillic script, and the signs of figures. Hints,
# kerning and names of glyphs are left out, because stb_truetype or film strips have no use for them.
set -eu
cd "$(dirname "$0")"
latin=U+0020-007E,U+00A0-017F,U+0218-021B,U+1E9E
accents=U+0300-0304,U+0306-030C,U+0327,U+0328
greek=U+0386,U+0388-038A,U+038C,U+038E-03CE
cyrillic=U+0400-045F,U+0490,U+0491
punctuation=U+2010-2015,U+2018-201E,U+2020-2022,U+2026,U+2030,U+2032,U+2033,U+2039,U+203A
numbers=U+2070,U+2074-2079,U+207B,U+2080-2089
signs=U+20AC,U+2116,U+2122,U+2190-2194,U+2206,U+2212,U+221A,U+221E,U+2248,U+2260,U+2264,U+2265
/usr/bin/python3 -m fontTools.subset /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf \
  --output-file=DejaVuSans-subset.ttf --no-hinting --no-glyph-names --notdef-outline \
  --name-IDs=0,1,2,13,14 --drop-tables+=FFTM,GDEF,GPOS,GSUB,MATH,gasp,kern \
  --unicodes="$latin,$accents,$greek,$cyrillic,$punctuation,$numbers,$signs,U+FFFD"
