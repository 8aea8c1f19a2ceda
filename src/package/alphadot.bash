# bash completion for alphadot: verbs, options, keys of the case after --set, files. The words are asked from the program.

_alphadot() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} verb words=""
  for verb in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do [[ $verb == -* ]] || break; done
  if [[ $previous == --set ]]; then
    compopt -o nospace
    words=$(alphadot keys 2>/dev/null | awk '/^\[/ {table = substr($1, 2, length($1) - 2) "."} /^  [a-z_]+ / {print table $1 "="}')
  elif ((COMP_CWORD == 1)); then
    words=$(alphadot --help 2>/dev/null | awk '/^Subcommands:/ {verbs = 1; next} verbs && /^  [a-z]/ {print $1}')
  elif [[ $current == -* ]]; then
    words=$(alphadot "$verb" --help 2>/dev/null | grep -oE -- '--[a-z]+(-[a-z]+)*' | sort -u)
  else
    compopt -o default
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
complete -F _alphadot alphadot
