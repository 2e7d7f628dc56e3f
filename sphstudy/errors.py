"""What the program refuses, in words for whoever asked."""


class ConfigurationError(ValueError):
    """Wrong input.

    Parameters
    ----------
    complaints : list of str
        One line each, naming key, value and what is allowed.
    """

    def __init__(self, complaints: list[str]):
        super().__init__("\n".join(complaints))
        self.complaints = complaints
