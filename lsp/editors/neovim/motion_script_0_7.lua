-- Neovim 0.7 to 0.10: in init.lua, or in a file that it loads.
local clients = {}

local function start(root)
  clients[root] = clients[root] or vim.lsp.start_client({
    name = "mlmg",
    cmd = { "mlmg", "lsp", "--stdio" },
    root_dir = root,
    on_exit = function()
      clients[root] = nil
    end,
  })
  return clients[root]
end

vim.api.nvim_create_autocmd({ "BufRead", "BufNewFile" }, {
  pattern = "*.ms",
  command = "set filetype=motion-script",
})
vim.api.nvim_create_autocmd("FileType", {
  pattern = "motion-script",
  callback = function(event)
    local folder = vim.fn.expand("<afile>:p:h")
    local found = vim.fn.findfile("mlmg.toml", folder .. ";")
    local client = start(found == "" and folder or vim.fn.fnamemodify(found, ":p:h"))
    if client then
      vim.lsp.buf_attach_client(event.buf, client)
    end
    vim.bo.commentstring = "# %s"
    vim.bo.omnifunc = "v:lua.vim.lsp.omnifunc"
    vim.keymap.set("n", "K", vim.lsp.buf.hover, { buffer = event.buf })
    vim.keymap.set("n", "grn", vim.lsp.buf.rename, { buffer = event.buf })
    vim.keymap.set("n", "gra", vim.lsp.buf.code_action, { buffer = event.buf })
    vim.keymap.set("n", "<C-]>", vim.lsp.buf.definition, { buffer = event.buf })
  end,
})
