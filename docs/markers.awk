# Markers between two meshes of one body in one pose: awk -f markers.awk first.obj second.obj
# Of the first file twenty vertices that are far from each other, and of the second the nearest.
$1 == "v" && FNR == NR { x[++n] = $2; y[n] = $3; z[n] = $4; d[n] = $2^2 + $4^2 + ($3 - 0.8)^2 }
$1 == "v" && FNR != NR { p[++m] = $2; q[m] = $3; r[m] = $4 }
END {
  for (k = 0; k < 20; ++k) {
    far = 1; for (i = 1; i <= n; ++i) if (d[i] > d[far]) far = i
    near = 1; best = 1e9
    for (j = 1; j <= m; ++j) {
      e = (p[j] - x[far])^2 + (q[j] - y[far])^2 + (r[j] - z[far])^2
      if (e < best) { best = e; near = j }
    }
    for (i = 1; i <= n; ++i) {
      e = (x[i] - x[far])^2 + (y[i] - y[far])^2 + (z[i] - z[far])^2
      if (e < d[i]) d[i] = e
    }
    print far, near
  }
}
