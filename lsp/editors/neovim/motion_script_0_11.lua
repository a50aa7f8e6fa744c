-- Neovim 0.11 and newer: in init.lua, or in a file that it loads.
vim.filetype.add({ extension = { ms = "motion-script" } })
vim.lsp.config("mlmg", {
  cmd = { "mlmg", "lsp", "--stdio" },
  filetypes = { "motion-script" },
  root_markers = { "mlmg.toml", ".git" },
})
vim.lsp.enable("mlmg")
