"""Draw everything that ``ui`` and the operators draw, without a window, and look up all that they name.

Each call on a layout has to be one that Blender has, each operator, property, icon, menu, panel and list that it names
has to be there; the first that is not raises ``MisnamedError``. Properties are read and lists drawn row by row.
"""

from types import SimpleNamespace

import bpy

UI = bpy.types.UILayout.bl_rna
ICONS = set(UI.functions["label"].parameters["icon"].enum_items.keys())
NUMBERS = {"INT": int, "FLOAT": (int, float), "BOOLEAN": bool, "STRING": str}
# Menus of Blender's own that ours are appended to.
EXTENDED = ("VIEW3D_MT_object", "VIEW3D_MT_edit_mesh_faces")
DRAWING = ("draw_header", "draw_header_preset", "draw")


class MisnamedError(AssertionError):
    """Something is drawn that is not there."""


class Record:
    """What was drawn: the texts of labels, the operators behind buttons, and the names of panels and menus."""

    def __init__(self):
        self.labels, self.operators, self.drawn = [], set(), set()


class Layout:
    """Stands for ``UILayout``."""

    def __init__(self, record):
        object.__setattr__(self, "record", record)

    def __setattr__(self, name, value):
        _refuse_unknown(name in UI.properties, f"Layouts have no {name!r}")
        _refuse_wrong_value(UI.properties[name], value)

    def __getattr__(self, name):
        _refuse_unknown(name in UI.functions, f"Layouts have no {name}()")
        return lambda *arguments, **options: self._called(name, *arguments, **options)

    def _called(self, name, *arguments, **options):
        self._check(name, options)
        return Layout(self.record)

    def _check(self, name, options):
        """Look up the options of a call that every kind of call can have."""
        parameters = UI.functions[name].parameters
        for option, value in options.items():
            _refuse_unknown(option in parameters, f"{name}() takes no {option!r}")
            if option == "icon":
                _refuse_unknown(value in ICONS, f"There is no icon {value!r}")
            elif value is not None:
                _refuse_wrong_value(parameters[option], value)

    def panel(self, idname, **options):
        self._check("panel", options)
        return Layout(self.record), Layout(self.record)

    def label(self, **options):
        self._check("label", options)
        self.record.labels.append(options.get("text", ""))

    def operator(self, operator, **options):
        self._check("operator", options)
        self.record.operators.add(operator)
        return Button(operator)

    def prop(self, data, property, **options):
        self._check("prop", options)
        _read(data, property)

    def prop_search(self, data, property, search_data, search_property, **options):
        self._check("prop_search", options)
        _read(data, property)
        _read(search_data, search_property)

    def menu(self, menu, **options):
        self._check("menu", options)
        _class_of(menu, bpy.types.Menu)
        self.record.drawn.add(menu)

    def popover(self, panel, **options):
        self._check("popover", options)
        _class_of(panel, bpy.types.Panel)

    def template_list(self, listtype, list_id, owner, rows_name, active_owner, active_name, **options):
        self._check("template_list", options)
        _read(active_owner, active_name)
        drawing = _class_of(listtype, bpy.types.UIList)
        self.record.drawn.add(listtype)
        for index, item in enumerate(_read(owner, rows_name)):
            drawing.draw_item(None, bpy.context, self, owner, item, 0, active_owner, active_name, index, 0)


class Button:
    """Stands for the properties of an operator that a button sets."""

    def __init__(self, operator):
        module, _, name = operator.partition(".")
        try:
            rna = getattr(getattr(bpy.ops, module), name).get_rna_type()
        except (AttributeError, KeyError):
            raise MisnamedError(f"There is no operator {operator!r}") from None
        object.__setattr__(self, "bl_rna", rna)

    def __setattr__(self, name, value):
        properties = self.bl_rna.properties
        _refuse_unknown(name in properties, f"{self.bl_rna.identifier} has no property {name!r}")
        _refuse_wrong_value(properties[name], value)


class Context:
    """The context of the sidebar, which has a width."""

    region = SimpleNamespace(width=300)

    def __getattr__(self, name):
        return getattr(bpy.context, name)


def draw_panels():
    """Draw all panels for the active object, and return what they say."""
    return draw_everything().labels


def draw_everything():
    """Draw all panels, menus and preferences of ours for the active object, and return a record of it."""
    record, context = Record(), Context()
    for drawing in registered(bpy.types.Panel):
        if not hasattr(drawing, "poll") or drawing.poll(context):
            draw(drawing, record, context)
    draw(bpy.types.EIGENPARTS_MT_object, record, context)
    if context.object and context.object.type == "MESH" and context.object.data.eigenparts.rows:
        draw(bpy.types.EIGENPARTS_MT_merge, record, context)
    for menu in EXTENDED:
        for entry in getattr(bpy.types, menu).draw._draw_funcs:
            if entry.__module__.startswith("eigenparts"):
                entry(SimpleNamespace(layout=Layout(record)), context)
    return record


def draw_preferences(preferences):
    """Draw the preferences of the extension, and return a record of it."""
    record, names = Record(), preferences.bl_rna.properties.keys()
    values = {name: getattr(preferences, name) for name in names if name != "rna_type"}
    draw(type(preferences), record, Context(), bl_rna=preferences.bl_rna, **values)
    return record


def draw_options_of_operators():
    """Draw what operators show to be changed afterwards, once for each choice of each list."""
    record = Record()
    for operator in registered(bpy.types.Operator):
        if not hasattr(operator, "draw"):
            continue
        rna = Button(operator.bl_idname).bl_rna
        declared = [one for one in rna.properties if one.identifier != "rna_type"]
        usual = {one.identifier: _default(one) for one in declared}
        lists = [one for one in declared if one.type == "ENUM" and not one.is_enum_flag]
        choices = [{one.identifier: item} for one in lists for item in _items(one)]
        for choice in [{}, *choices]:
            draw(operator, record, Context(), bl_rna=rna, properties=SimpleNamespace(bl_rna=rna), **usual | choice)
    return record


def draw(drawing, record, context, **values):
    """Draw one panel, menu or operator, with its headers."""
    drawn = _stand_in(drawing)(layout=Layout(record), **values)
    for part in DRAWING:
        if hasattr(drawn, part):
            getattr(drawn, part)(context)
            record.drawn.add(drawing.__name__)


def _stand_in(drawing):
    """Return a class with what a class of Blender's has of Python: only Blender itself makes instances of it."""
    of_python = tuple(base for base in drawing.__mro__ if not issubclass(base, bpy.types.bpy_struct))
    values = {name: value for name, value in vars(drawing).items() if not name.startswith("__") and name != "bl_rna"}
    values.setdefault("bl_idname", drawing.__name__)
    return type(drawing.__name__, (SimpleNamespace, *of_python[:-1]), values)


def registered(kind):
    """Return the registered classes of a kind that are ours."""
    return [one for one in kind.__subclasses__() if one.__module__.startswith("eigenparts") and one.is_registered]


def _class_of(name, kind):
    found = getattr(bpy.types, name, None)
    _refuse_unknown(found is not None and issubclass(found, kind), f"There is no {kind.__name__} {name!r}")
    return found


def _read(data, name):
    _refuse_unknown(name in data.bl_rna.properties, f"{data.bl_rna.identifier} has no property {name!r}")
    return getattr(data, name)


def _default(declared):
    if declared.type == "ENUM" and declared.is_enum_flag:
        return declared.default_flag
    return getattr(declared, "default", None)


def _items(declared):
    return list(declared.enum_items.keys())


def _refuse_wrong_value(declared, value):
    """Raise if a value is none that a property of Blender's takes."""
    place = f"{declared.identifier!r} takes no {value!r}"
    if declared.type == "ENUM":
        # The items of some are only known at run time.
        items = _items(declared)
        _refuse_unknown(not items or value in items or declared.is_enum_flag, place)
    elif declared.type in NUMBERS and not getattr(declared, "is_array", False):
        _refuse_unknown(isinstance(value, NUMBERS[declared.type]), place)


def _refuse_unknown(is_known, sentence):
    if not is_known:
        raise MisnamedError(sentence + ".")
