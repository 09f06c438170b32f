"""Operators that are done at once, and say why where they cannot be pressed."""

from .problem import Problem


class Guarded:
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        try:
            cls.require(context)
        except Problem as problem:
            cls.poll_message_set(str(problem))
            return False
        return True

    def execute(self, context):
        try:
            self.change(context)
        except Problem as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        return {"FINISHED"}

    @staticmethod
    def require(context) -> None:
        """Raises a Problem if it can be seen at once that the operator cannot be pressed."""
        raise NotImplementedError

    def change(self, context) -> None:
        """What the operator does. May raise a Problem."""
        raise NotImplementedError
