"""`sphstudy --cfg job`: the settings of a run. `sphstudy --info searchpath`: where they are found."""

import yaml

from sphstudy.commands.parser import Request
from sphstudy.configuration.composition import session
from sphstudy.configuration.overrides import launcher_overrides
from sphstudy.errors import ConfigurationError

_OFFERED = {"cfg": "job", "info": "searchpath"}
_INSTEAD = {
    "cfg": "settings of launchers stand in conf/hydra/launcher",
    "info": "--cfg job prints the settings, `sphstudy describe NAME` their meanings",
}


def run(request: Request) -> int:
    """Prints the settings that one run would have as YAML, or the folders of settings; runs nothing."""
    for option, offered in _OFFERED.items():
        if (given := request.options.get(option, offered)) != offered:
            raise ConfigurationError(
                [f"--{option} {given}: write --{option} {offered}; {_INSTEAD[option]}"]
            )
    settings = [s for s in request.settings if s not in launcher_overrides(list(request.settings))]
    with session(request.config_dir) as hydra:
        if "info" in request.options:
            print(*hydra.search_path(), sep="\n")
        else:
            composed = hydra.composed(settings)
            print(yaml.safe_dump(composed, sort_keys=False, allow_unicode=True), end="")
    return 0
