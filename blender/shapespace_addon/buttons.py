"""Buttons that run operators with the scene's settings."""


def draw(layout, context, operator: str, icon: str) -> None:
    settings = context.scene.shapespace
    properties = layout.operator(operator, icon=icon)
    for name in properties.bl_rna.properties.keys():
        if name != "rna_type":
            setattr(properties, name, getattr(settings, name))
