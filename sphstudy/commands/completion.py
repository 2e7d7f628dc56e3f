"""`sphstudy --shell-completion install=bash`: completion for bash, printed for `eval`."""

from sphstudy import catalogue
from sphstudy.commands.grammar import COMMANDS
from sphstudy.commands.parser import Request
from sphstudy.configuration import study_file
from sphstudy.errors import ConfigurationError

_KEYS = "h= n= seed= results= checkpoint= threads= time_limit= memory_limit= retry= hydra/launcher="
_GROUPS = ("scene", "method", "solve")
_SCRIPT = """\
_sphstudy() {{
    local line="${{COMP_LINE:0:COMP_POINT}}"
    local current="${{line##* }}" words
    case "$current" in
{values}
        -*) case "${{COMP_WORDS[1]}}" in
{options}
            esac ;;
        *) case "${{COMP_WORDS[1]}}" in
            "$current") words="{commands} {keys}" ;;
            study | report | compare | judge | measure | reference | status | extrapolate)
                words="{studies} {keys}" ;;
            describe) words="{names}" ;;
            *) words="{keys}" ;;
            esac ;;
    esac
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    [[ ${{COMPREPLY[0]}} == *= ]] && compopt -o nospace
    # bash takes what stands behind "=" for a word of its own.
    [[ $current == *=* ]] && COMPREPLY=("${{COMPREPLY[@]#"${{current%%=*}}="}}")
    return 0
}}
complete -o default -F _sphstudy sphstudy
"""


def run(request: Request) -> int:
    """Prints the script, or what takes it back."""
    asked = request.options["shell-completion"]
    if asked == "uninstall=bash":
        print("complete -r sphstudy; unset -f _sphstudy")
        return 0
    if asked != "install=bash":
        wrong = (
            f"--shell-completion {asked}: there is install=bash, and uninstall=bash that takes it back"
        )
        raise ConfigurationError([wrong])
    names = {group: catalogue.names(group) for group in _GROUPS}
    values = [f'        {g}=*) words="{" ".join(f"{g}={n}" for n in names[g])}" ;;' for g in _GROUPS]
    options = [
        f'            {"*" if name == "run" else name}) words="{_options(name)}" ;;'
        for name in sorted(COMMANDS, key=lambda name: name == "run")
    ]
    print(
        _SCRIPT.format(
            values="\n".join(values),
            options="\n".join(options),
            commands=" ".join(COMMANDS),
            keys=" ".join([*(f"{group}=" for group in _GROUPS), _KEYS]),
            studies=" ".join(study_file.names()),
            names=" ".join([*_GROUPS, *(name for group in _GROUPS for name in names[group])]),
        ),
        end="",
    )
    return 0


def _options(name: str) -> str:
    return " ".join([*(s for option in COMMANDS[name].options for s in option.spellings), "--help"])
