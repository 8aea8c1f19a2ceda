# bash completion for alphadot-sweep: verbs, options, files. The words are asked from the program.

_alphadot_sweep() {
  local current=${COMP_WORDS[COMP_CWORD]} words=""
  if ((COMP_CWORD == 1)); then
    words=$(alphadot-sweep --help 2>/dev/null | awk '/^  sweep.py [a-z]+ / {print $2}')
  elif [[ $current == -* ]]; then
    words=$(alphadot-sweep "${COMP_WORDS[1]}" --help 2>/dev/null | grep -oE -- '--[a-z]+(-[a-z]+)*' | sort -u)
  else
    compopt -o default
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
complete -F _alphadot_sweep alphadot-sweep
