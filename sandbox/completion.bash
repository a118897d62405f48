# Completion for bash: source it, or install the program, which puts it where bash-completion looks. Verbs, options and
# scenes are asked of the program itself.
_shatterbox() {
  local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
  local verb=() choices=""
  if ((COMP_CWORD == 1)); then
    choices=$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,$s/^  \([a-z]\+\) .*/\1/p')
    mapfile -t COMPREPLY < <(compgen -W "$choices --help --version" -- "$word")
    return
  fi
  verb=("${COMP_WORDS[1]}")
  if [[ ${verb[0]} == golden ]]; then
    if ((COMP_CWORD == 2)); then
      mapfile -t COMPREPLY < <(compgen -W "make check" -- "$word")
      return
    fi
    verb+=("${COMP_WORDS[2]}")
  fi
  case $before in
    --quality) choices="preview full" ;;
    --gl) choices="osmesa egl" ;;
    --tolerance) choices="default exact video" ;;
    --size) choices="320x180 640x360 1280x720 1920x1080" ;;
    -o | --frames | --meshes | --export | --tables | --truth | --record | --report | --script | --picture | --pictures | --junit)
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      return
      ;;
  esac
  if [[ -z $choices && $word == -* ]]; then
    choices=$("$program" "${verb[@]}" --help 2>/dev/null | sed -n 's/^  \(\(-[a-z],\)\?-[-a-z]*\).*/\1/p' | tr ',' '\n')
  elif [[ -z $choices ]]; then
    case ${verb[0]} in
      run | check | plan | batch | study)
        choices=$("$program" list 2>/dev/null | sed -n '/^scenes/,/^[a-z]/s/^    \([^ ]*\) .*/\1/p')
        [[ ${verb[0]} == study ]] && choices+=" $("$program" list 2>/dev/null | sed -n '/^studies/,/^[a-z]*$/s/^    \([^ ]*\) .*/\1/p')"
        ;;
      diff | golden) choices="" ;;
    esac
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word"; compgen -f -- "$word")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
}
complete -o filenames -F _shatterbox shatterbox
