"""Motion Script in editors that speak the language server protocol."""
