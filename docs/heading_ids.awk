# Doxygen's input filter for docs/scene.md: gives every heading the name by which GitHub links to it
# ("## Body type: fem" is #body-type-fem), with a prefix, since Doxygen's names are global.
/^```/ { fenced = !fenced }
!fenced && /^#+ / {
  name = tolower($0)
  sub(/^#+ +/, "", name)
  gsub(/[^a-z0-9 _-]/, "", name)
  gsub(/ /, "-", name)
  $0 = $0 " {#scene-" name "}"
}
{ gsub(/\]\(#/, "](#scene-"); print }
