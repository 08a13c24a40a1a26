"""How a service of the client ends (Appendix 3.3 of Cnet EN)."""
NO_HEAD, NO_TAIL, WRONG_CHECK, WRONG_STATION, WRONG_DRIVER, TIME_OUT, LENGTH, NOT_HEX, RANGE, REFUSED = 1, 2, 3, 4, 5, 10, 11, 13, 14, 15


class Done(Exception):
    """The service has ended: status 0 and what to save, or an error."""
    def __init__(self, status, values=None):
        super().__init__(status)
        self.status, self.values = status, values
