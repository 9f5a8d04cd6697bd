"""mypy plugin: corrects what Drake's stubs state too strictly or too weakly (Drake 1.58).

Python binds these functions to C++ templates and converts their arguments, which the generated stubs cannot express:

- what returns `object` (`Eval` of a port, a shape, a property) has the type of its value: here Any;
- `GetJointByName`, `GetSubsystemByName` and the like return a base class: here Any;
- `AddSystem` and `AddNamedSystem` return `System`: here the type of their argument;
- typed indices (`DiscreteStateIndex`) are not accepted where `int` is declared;
- calculations of abstract values take `object`: here Any;
- sequences of numbers are not accepted where an array is declared.
"""

from collections.abc import Callable

from mypy.nodes import TypeInfo
from mypy.plugin import FunctionSigContext, MethodContext, MethodSigContext, Plugin
from mypy.types import AnyType, CallableType, FunctionLike, Instance, Type, TypeOfAny, UnionType, get_proper_type

FRAMEWORK = "pydrake.systems.framework"
INDICES = tuple(f"{FRAMEWORK}.{kind}Index" for kind in ("DiscreteState", "AbstractState", "AbstractParameter"))
"""What `LeafSystem.Declare...` returns."""
TOO_GENERAL = ("builtins.object", f"{FRAMEWORK}.System", "pydrake.multibody.tree.Joint")
"""Classes that are returned for any of their subclasses."""


class DrakePlugin(Plugin):
    """Better types for the calls into `pydrake.systems`."""

    def get_method_hook(self, fullname: str) -> Callable[[MethodContext], Type] | None:
        return _returned if fullname.startswith("pydrake.") else None

    def get_method_signature_hook(self, fullname: str) -> Callable[[MethodSigContext], FunctionLike] | None:
        is_declaration = fullname.endswith(".DeclareAbstractOutputPort")  # named by the class of the caller
        return self._accept_more if is_declaration or fullname.startswith("pydrake.") else None

    def get_function_signature_hook(self, fullname: str) -> Callable[[FunctionSigContext], FunctionLike] | None:
        return self._accept_more if fullname.startswith("pydrake.") else None

    def _accept_more(self, context: MethodSigContext | FunctionSigContext) -> FunctionLike:
        signature = context.default_signature
        return signature.copy_modified(arg_types=[self._widened(argument) for argument in signature.arg_types])

    def _widened(self, argument: Type) -> Type:
        proper = get_proper_type(argument)
        if _is_instance(proper, "builtins.int"):
            return UnionType([proper, *map(self._instance, INDICES)])
        if _is_instance(proper, "numpy.ndarray"):
            return UnionType([proper, self._instance("typing.Sequence", self._instance("builtins.float"))])
        if isinstance(proper, CallableType):
            objects = [_is_instance(kind, "builtins.object") for kind in proper.arg_types]
            anything = AnyType(TypeOfAny.special_form)
            kinds = [anything if is_object else kind for kind, is_object in zip(proper.arg_types, objects, strict=True)]
            return proper.copy_modified(arg_types=kinds)
        return argument

    def _instance(self, fullname: str, *arguments: Type) -> Type:
        symbol = self.lookup_fully_qualified(fullname)
        assert symbol is not None and isinstance(symbol.node, TypeInfo)
        return Instance(symbol.node, arguments)


def _returned(context: MethodContext) -> Type:
    default = context.default_return_type
    if _is_instance(default, f"{FRAMEWORK}.System") and "system" in context.callee_arg_names:
        (system,) = context.arg_types[context.callee_arg_names.index("system")]
        return system
    return AnyType(TypeOfAny.special_form) if any(_is_instance(default, name) for name in TOO_GENERAL) else default


def _is_instance(kind: Type, fullname: str) -> bool:
    proper = get_proper_type(kind)
    return isinstance(proper, Instance) and proper.type.fullname == fullname


def plugin(_version: str) -> type[Plugin]:
    """mypy's entry point."""
    return DrakePlugin
