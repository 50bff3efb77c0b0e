# Doxygen's input filter for pages: gives every heading below the title the name by which GitHub
# links to it ("## Body type: fem" is #body-type-fem, a second one #body-type-fem-1), after the
# page's, since Doxygen's names are global (#scene-body-type-fem); links name those.
NR == 1 {
  page = FILENAME
  sub(/.*\//, "", page)
  sub(/\.md$/, "", page)
}
/^```/ { fenced = !fenced }
!fenced && /^##+ / {
  name = tolower($0)
  sub(/^#+ +/, "", name)
  gsub(/[^a-z0-9 _-]/, "", name)
  gsub(/ /, "-", name)
  if (times[name]++) name = name "-" (times[name] - 1)
  $0 = $0 " {#" page "-" name "}"
}
{
  gsub(/<a id="/, "&" page "-")
  gsub(/\]\(#/, "&" page "-")
  while (match($0, /\]\([A-Za-z0-9_\/.-]+\.md#/)) {
    target = substr($0, RSTART + 2, RLENGTH - 6)
    sub(/.*\//, "", target)
    $0 = substr($0, 1, RSTART) "(#" target "-" substr($0, RSTART + RLENGTH)
  }
  print
}
