#include "harness/usage/completion_scripts.hpp"

#include <utility>

namespace fieldproof::usage {

namespace {

// The line is split by blanks alone: bash itself splits at ':' and '=' too, and replaces only what
// stands behind the last of them.
constexpr std::string_view bash = R"(# bash completion of TOOL
_TOOL() {
    local line=${COMP_LINE:0:COMP_POINT} words word one
    read -ra words <<<"$line"
    [[ $line == *[[:space:]] ]] && words+=("")
    word=${words[-1]}
    local cut=${word%"${word##*[:=]}"}
    COMPREPLY=()
    while IFS=$'\t' read -r one _; do
        COMPREPLY+=("${one#"$cut"}")
    done < <("$1" __complete "${words[@]:1}" 2>/dev/null)
    [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *[/:=] ]] && compopt -o nospace
    return 0
}
complete -o default -F _TOOL TOOL
)";

constexpr std::string_view zsh = R"(#compdef TOOL
# zsh completion of TOOL
_TOOL() {
    local -a whole parts
    local line word
    while IFS=$'\t' read -r word line; do
        if [[ $word == *[/:=] ]]; then
            parts+=("$word")
        else
            whole+=("${word//:/\\:}${line:+:$line}")
        fi
    done < <("${words[1]}" __complete "${(@)words[2,CURRENT]}" 2>/dev/null)
    if (( ${#whole} + ${#parts} == 0 )); then
        _files
        return
    fi
    (( ${#parts} )) && compadd -S '' -- "${parts[@]}"
    (( ${#whole} )) && _describe TOOL whole
}
if [[ $funcstack[1] == _TOOL ]]; then
    _TOOL "$@"
else
    compdef _TOOL TOOL
fi
)";

constexpr std::string_view fish = R"(# fish completion of TOOL
function __TOOL_complete
    set -l words (commandline -opc) (commandline -ct)
    set -l found ($words[1] __complete $words[2..] 2>/dev/null)
    if test (count $found) -gt 0
        printf '%s\n' $found
    else
        __fish_complete_path (commandline -ct)
    end
end
complete -c TOOL -f -a '(__TOOL_complete)'
)";

}  // namespace

std::string completion_script(std::string_view shell, std::string_view tool) {
  std::string script(shell == "bash" ? bash : shell == "zsh" ? zsh : fish);
  constexpr std::string_view placeholder = "TOOL";
  for (std::size_t at = 0; (at = script.find(placeholder, at)) != std::string::npos;)
    script.replace(at, placeholder.size(), tool);
  return script;
}

}  // namespace fieldproof::usage
